#include "scene/pbrt/importer.h"

#include "scene/emitters/environment.h"
#include "scene/load/suggest.h"

#include <fmt/format.h>

namespace keyhole::pbrt {
namespace {

/// Enough of a directive for later messages.
Directive head_of(const Directive& d) {
    Directive head;
    head.name = d.name;
    head.position = d.position;
    head.words = d.words;
    return head;
}

/// Directives that set up the view come before WorldBegin, the rest after it.
bool is_option(const std::string& name) {
    static const std::set<std::string_view> kOptions{"Accelerator", "Camera",      "Film",    "Integrator",
                                                     "Option",      "PixelFilter", "Sampler", "SurfaceIntegrator",
                                                     "WorldBegin"};
    return kOptions.contains(name);
}
bool is_anywhere(const std::string& name) {
    static const std::set<std::string_view> kAnywhere{
        "ActiveTransform",    "Attribute",      "ColorSpace", "CoordinateSystem", "CoordSysTransform",
        "Identity",           "Include",        "Import",     "MakeNamedMedium",  "MediumInterface",
        "ReverseOrientation", "TransformTimes", "WorldEnd"};
    return kAnywhere.contains(name);
}

bool defines_a_name(const std::string& name) {
    static const std::set<std::string_view> kDefinitions{"CoordinateSystem", "MakeNamedMaterial", "MakeNamedMedium",
                                                         "Texture"};
    return kDefinitions.contains(name);
}

} // namespace

const std::map<std::string_view, Importer::Handler>& Importer::handlers() {
    static const std::map<std::string_view, Handler> table{{"ActiveTransform", &Importer::set_active_transform},
                                                           {"AreaLightSource", &Importer::add_area_light},
                                                           {"Attribute", &Importer::set_attribute},
                                                           {"AttributeBegin", &Importer::begin_block},
                                                           {"AttributeEnd", &Importer::end_block},
                                                           {"Camera", &Importer::note_camera},
                                                           {"ColorSpace", &Importer::set_color_space},
                                                           {"CoordSysTransform", &Importer::use_coordinate_system},
                                                           {"CoordinateSystem", &Importer::set_coordinate_system},
                                                           {"Film", &Importer::note_option},
                                                           {"Import", &Importer::import},
                                                           {"Include", &Importer::include},
                                                           {"Integrator", &Importer::note_option},
                                                           {"LightSource", &Importer::add_light},
                                                           {"MakeNamedMaterial", &Importer::define_material},
                                                           {"MakeNamedMedium", &Importer::define_medium},
                                                           {"Material", &Importer::use_material},
                                                           {"MediumInterface", &Importer::use_media},
                                                           {"NamedMaterial", &Importer::use_named_material},
                                                           {"ObjectBegin", &Importer::begin_object},
                                                           {"ObjectEnd", &Importer::end_block},
                                                           {"ObjectInstance", &Importer::place_object},
                                                           {"PixelFilter", &Importer::note_option},
                                                           {"ReverseOrientation", &Importer::reverse_orientation},
                                                           {"Sampler", &Importer::note_option},
                                                           {"Shape", &Importer::add_shape},
                                                           {"SurfaceIntegrator", &Importer::note_option},
                                                           {"Texture", &Importer::define_texture},
                                                           {"TransformBegin", &Importer::begin_block},
                                                           {"TransformEnd", &Importer::end_block},
                                                           {"WorldBegin", &Importer::begin_world}};
    return table;
}

Importer::Importer(const std::string& path, std::vector<std::string>* warnings, const Settings& settings)
    : warnings_(warnings), files_(path), context_{warnings_, files_.directory()}, settings_(settings) {
    state_.material.material = make_diffuse(Rgb(0.5)); // pbrt's default
}

void Importer::run() {
    try {
        while (const auto directive = next()) {
            leave_imports();
            const auto act = [&] { carry_out(*directive); };
            defines_a_name(directive->name) ? mistakes_.attempt_definition(act) : mistakes_.attempt(act);
        }
        // What was passed over may have had them.
        if (!mistakes_.empty()) return;
        if (!in_world_) throw FatalInputError(files_.begin(), "found no WorldBegin, expected it and a scene after it");
        if (!blocks_.empty())
            blocks_.back().begin.fail("found no end of the block, expected it before the end of the file");
    } catch (const InputError& e) {
        mistakes_.note(e);
        mistakes_.lose_names();
    }
}

/// The next directive that keeps to the grammar.
std::optional<Directive> Importer::next() {
    for (;;) {
        try {
            return files_.next();
        } catch (const InputError& e) {
            mistakes_.note(e);
            mistakes_.lose_names();
            files_.skip_to_directive();
        }
    }
}

SceneDescription Importer::take_description() {
    SceneDescription description;
    description.camera = view_.camera;
    description.window = view_.window;
    mistakes_.attempt([&] {
        if (!camera_medium_.empty()) description.medium = media_.look_up(camera_medium_, options_.at("Camera"));
    });
    description.shapes = build_shapes(std::move(records_), placements_, materials_, warnings_, mistakes_);
    mistakes_.report();
    if (description.shapes.empty() && environments_.empty())
        throw InputError(files_.begin(), "found an empty scene, expected at least one shape or an infinite light");
    description.emitters = std::move(emitters_);
    if (environments_.size() > 1)
        description.emitters.push_back(make_environment_sum(std::move(environments_)));
    else if (!environments_.empty())
        description.emitters.push_back(std::move(environments_.front()));
    return description;
}

void Importer::carry_out(const Directive& d) {
    for (const Parameter& p : d.overruled)
        warnings_.add(p.position, "repeated " + d.title() + " " + p.name,
                      fmt::format("{}: '{}' is given again: the last one counts", d.title(), p.name));
    Transform unused;
    if (apply_transform(d, moves_end_only_ ? unused : state_.to_world)) return;
    if (is_option(d.name) == in_world_ && !is_anywhere(d.name)) {
        if (in_world_) d.fail("found it after WorldBegin, expected it before");
        d.stop("found it before WorldBegin, expected it after");
    }
    const auto handler = handlers().find(d.name);
    if (handler != handlers().end()) (this->*handler->second)(d); // the others change no picture
}

/// What an imported file does to the graphics state ends with it.
void Importer::leave_imports() {
    while (!imports_.empty() && files_.depth() < imports_.back().depth) {
        state_ = std::move(imports_.back().outer);
        imports_.pop_back();
    }
}

Parameters Importer::parameters(const Directive& d, const char* attribute) const {
    const auto found = attribute != nullptr ? state_.attributes.find(attribute) : state_.attributes.end();
    return {d, found != state_.attributes.end() ? &found->second : nullptr, context_};
}

void Importer::note_option(const Directive& d) { options_[d.name == "SurfaceIntegrator" ? "Integrator" : d.name] = d; }

void Importer::note_camera(const Directive& d) {
    if (!(regularity(state_.to_world) > 1e-12))
        d.fail("found a transform that flattens the world, expected a regular one");
    camera_to_world_ = state_.to_world.inverse();
    coordinate_systems_["camera"] = camera_to_world_;
    camera_medium_ = state_.outside_medium;
    note_option(d);
}

void Importer::begin_world(const Directive& d) {
    in_world_ = true;
    const auto option = [&](const char* name, const char* otherwise) {
        const auto found = options_.find(name);
        if (found != options_.end()) return found->second;
        Directive standard;
        standard.name = name;
        standard.position = d.position;
        standard.words = {otherwise};
        return standard;
    };
    const Directive film = option("Film", "rgb"), camera = option("Camera", "perspective");
    const Directive integrator = option("Integrator", "volpath"), sampler = option("Sampler", "zsobol");
    const Directive filter = option("PixelFilter", "gaussian");
    const auto read = [&](const Directive& directive, auto&& reader) {
        Parameters p = parameters(directive);
        mistakes_.attempt([&] { reader(p); });
    };
    read(film, [&](Parameters& p) { read_film(p, view_); });
    read(camera, [&](Parameters& p) { read_camera(p, camera_to_world_, view_); });
    read(integrator, [&](Parameters& p) { read_integrator(p, settings_); });
    read(sampler, [&](Parameters& p) { read_sampler(p, settings_); });
    read(filter, [&](Parameters& p) { read_filter(p, settings_); });
    state_.to_world = Transform();
    coordinate_systems_["world"] = Transform();
}

void Importer::begin_block(const Directive& d) { blocks_.push_back({head_of(d), state_}); }

void Importer::end_block(const Directive& d) {
    const std::string kind = d.name.substr(0, d.name.size() - std::string_view("End").size());
    if (blocks_.empty()) d.stop(fmt::format("found it without {}Begin, expected one before", kind));
    const Directive& begin = blocks_.back().begin;
    if (begin.name != kind + "Begin")
        d.stop(fmt::format("found it in the block of {} (at {}), expected that to end first", begin.title(),
                           begin.position.to_string()));
    if (kind == "Object") open_object_ = nullptr;
    if (kind == "Transform")
        state_.to_world = blocks_.back().outer.to_world;
    else
        state_ = std::move(blocks_.back().outer);
    blocks_.pop_back();
}

void Importer::set_attribute(const Directive& d) {
    static const std::set<std::string_view> kTargets{"shape", "light", "material", "medium", "texture"};
    if (!kTargets.contains(d.words[0]))
        d.fail(fmt::format("found the target '{}', {}", d.words[0],
                           expected_one_of(d.words[0], {kTargets.begin(), kTargets.end()})));
    auto& defaults = state_.attributes[d.words[0]];
    defaults.insert(defaults.begin(), d.parameters.begin(), d.parameters.end()); // later ones are found first
}

void Importer::set_coordinate_system(const Directive& d) { coordinate_systems_[d.words[0]] = state_.to_world; }

void Importer::use_coordinate_system(const Directive& d) {
    const auto found = coordinate_systems_.find(d.words[0]);
    if (found != coordinate_systems_.end()) {
        state_.to_world = found->second;
        return;
    }
    std::vector<std::string_view> names;
    for (const auto& [name, transform] : coordinate_systems_) names.push_back(name);
    d.fail_unknown(
        d.position, fmt::format("coordinate system '{}'", d.words[0]),
        fmt::format("found the unknown coordinate system '{}', {}", d.words[0], expected_one_of(d.words[0], names)));
}

void Importer::reverse_orientation(const Directive& /*d*/) { state_.reversed = !state_.reversed; }

void Importer::set_active_transform(const Directive& d) {
    if (d.words[0] != "StartTime" && d.words[0] != "EndTime" && d.words[0] != "All")
        d.fail(fmt::format("found '{}', expected StartTime, EndTime or All", d.words[0]));
    moves_end_only_ = d.words[0] == "EndTime";
    if (moves_end_only_)
        warnings_.add(d.position, "motion",
                      "ActiveTransform: nothing moves: everything stands where it is as the shutter opens");
}

void Importer::set_color_space(const Directive& d) {
    if (d.words[0] != "srgb") d.fail(fmt::format("found the colour space '{}', expected srgb", d.words[0]));
}

void Importer::include(const Directive& d) { files_.enter(d, d.words[0]); }

void Importer::import(const Directive& d) {
    files_.enter(d, d.words[0]);
    imports_.push_back({files_.depth(), state_});
}

} // namespace keyhole::pbrt
