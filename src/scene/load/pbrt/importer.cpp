#include "scene/load/pbrt/importer.h"

#include "scene/load/input.h"

#include <fmt/format.h>

namespace keyhole::pbrt {
const std::map<std::string_view, Importer::Rule>& Importer::rules() {
    using I = Importer;
    constexpr Where options = Where::options, world = Where::world, anywhere = Where::anywhere;
    static const std::map<std::string_view, Rule> table{
        {"Accelerator", {options, nullptr}},
        {"ActiveTransform", {anywhere, &I::set_active_transform}},
        {"AreaLightSource", {world, &I::add_area_light}},
        {"Attribute", {anywhere, &I::set_attribute}},
        {"AttributeBegin", {world, &I::begin_block}},
        {"AttributeEnd", {world, &I::end_block}},
        {"Camera", {options, &I::note_camera}},
        {"ColorSpace", {anywhere, &I::set_color_space}},
        {"CoordSysTransform", {anywhere, &I::use_coordinate_system}},
        {"CoordinateSystem", {anywhere, &I::set_coordinate_system, true}},
        {"Film", {options, &I::note_option}},
        {"Import", {anywhere, &I::import}},
        {"Include", {anywhere, &I::include}},
        {"Integrator", {options, &I::note_option}},
        {"LightSource", {world, &I::add_light}},
        {"MakeNamedMaterial", {world, &I::define_material, true}},
        {"MakeNamedMedium", {anywhere, &I::define_medium, true}},
        {"Material", {world, &I::use_material}},
        {"MediumInterface", {anywhere, &I::use_media}},
        {"NamedMaterial", {world, &I::use_named_material}},
        {"ObjectBegin", {world, &I::begin_object}},
        {"ObjectEnd", {world, &I::end_block}},
        {"ObjectInstance", {world, &I::place_object}},
        {"Option", {options, nullptr}},
        {"PixelFilter", {options, &I::note_option}},
        {"ReverseOrientation", {anywhere, &I::reverse_orientation}},
        {"Sampler", {options, &I::note_option}},
        {"Shape", {world, &I::add_shape}},
        {"SurfaceIntegrator", {options, &I::note_option}},
        {"Texture", {world, &I::define_texture, true}},
        {"TransformBegin", {world, &I::begin_block}},
        {"TransformEnd", {world, &I::end_block}},
        {"TransformTimes", {anywhere, nullptr}},
        {"WorldBegin", {options, &I::begin_world}},
        {"WorldEnd", {anywhere, nullptr}}};
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
            const auto rule = rules().find(directive->name);
            const bool defines = rule != rules().end() && rule->second.defines_a_name;
            defines ? mistakes_.attempt_definition(act) : mistakes_.attempt(act);
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
        if (!camera_medium_.empty()) description.medium = find_medium(library_, camera_medium_, options_.at("Camera"));
    });
    description.shapes = build_shapes(std::move(records_), placements_, library_, warnings_, mistakes_);
    mistakes_.report();
    if (description.shapes.empty() && environments_.empty())
        throw InputError(files_.begin(), "found an empty scene, expected at least one shape or an infinite light");
    description.emitters = std::move(emitters_);
    for (EmitterPtr& environment : environments_) description.emitters.push_back(std::move(environment));
    return description;
}

void Importer::carry_out(const Directive& d) {
    for (const Parameter& p : d.overruled)
        warnings_.add(p.position, "repeated " + d.title() + " " + p.name,
                      fmt::format("{}: '{}' is given again: the last one counts", d.title(), p.name));
    Transform unused;
    if (apply_transform(d, moves_end_only_ ? unused : state_.to_world)) return;
    const Rule& rule = rules().at(d.name);
    if ((rule.where == Where::options) == in_world_ && rule.where != Where::anywhere) {
        if (in_world_) d.fail("found it after WorldBegin, expected it before");
        d.stop("found it before WorldBegin, expected it after");
    }
    if (rule.act != nullptr) (this->*rule.act)(d); // the others change no picture
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

void Importer::begin_block(const Directive& d) { blocks_.push_back({d.head(), state_}); }

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
    state_.to_world = d.look_up(coordinate_systems_, "coordinate system", d.words[0]);
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
