#include "scene/load/suggest.h"
#include "scene/pbrt/importer.h"

#include <fmt/format.h>

namespace keyhole::pbrt {

void Importer::begin_object(const Directive& d) {
    if (open_object_ != nullptr) d.stop("found an object within an object, expected the first to end before");
    if (objects_.contains(d.words[0]))
        d.stop(fmt::format("found the object '{}' again, expected another name", d.words[0]));
    begin_block(d);
    open_object_ = &objects_[d.words[0]];
}

void Importer::place_object(const Directive& d) {
    if (open_object_ != nullptr) d.fail("found an instance within an object, expected the object to end before");
    const auto found = objects_.find(d.words[0]);
    if (found == objects_.end()) {
        std::vector<std::string_view> names;
        for (const auto& [name, records] : objects_) names.push_back(name);
        d.fail_unknown(
            d.position, fmt::format("object '{}'", d.words[0]),
            fmt::format("found the unknown object '{}', {}", d.words[0], expected_one_of(d.words[0], names)));
    }
    if (placements_.size() + found->second.size() > kMaxShapes)
        d.stop(fmt::format("found more than {} shapes, expected fewer", kMaxShapes));
    ++instances_;
    for (const std::size_t record : found->second) placements_.push_back({record, state_.to_world});
}

void Importer::define_texture(const Directive& d) {
    Parameters p = parameters(d, "texture");
    textures_.define(p);
}

void Importer::define_material(const Directive& d) {
    Parameters p = parameters(d, "material");
    materials_.define(p, textures_);
}

void Importer::define_medium(const Directive& d) {
    Parameters p = parameters(d, "medium");
    media_.define(p);
}

void Importer::use_material(const Directive& d) {
    Parameters p = parameters(d, "material");
    state_.material = materials_.read(d.words[0], p, textures_);
    state_.material_name.clear();
}

void Importer::use_named_material(const Directive& d) { state_.material_name = d.words[0]; }

void Importer::use_media(const Directive& d) {
    state_.inside_medium = d.words.front();
    state_.outside_medium = d.words.back();
}

void Importer::add_area_light(const Directive& d) {
    Parameters p = parameters(d, "light");
    state_.area_light = read_area_light(p, view_.exposure);
}

void Importer::add_light(const Directive& d) {
    Parameters p = parameters(d, "light");
    LightSource light = read_light(p, state_.to_world, view_.exposure);
    if (light.emitter) (light.environment ? environments_ : emitters_).push_back(std::move(light.emitter));
}

void Importer::add_shape(const Directive& d) {
    Parameters p = parameters(d, "shape");
    ShapeRecord record;
    record.source = read_shape(p);
    record.directive.name = d.name;
    record.directive.position = d.position;
    record.directive.words = d.words;
    record.to_world = state_.to_world;
    record.reversed = state_.reversed;
    record.material = state_.material;
    record.material_name = state_.material_name;
    record.light = state_.area_light;
    record.alpha = textures_.find_number(p, "alpha", kShare);
    p.ignore({"shadowalpha"}); // v3: what shadow rays see; here as all rays
    p.warn_of_the_rest();
    if (open_object_ != nullptr && record.light) {
        p.warn("light in object", "the area light is ignored, as pbrt does in objects");
        record.light.reset();
    }
    record.inside = media_.look_up(state_.inside_medium, d);
    record.outside = media_.look_up(state_.outside_medium, d);
    records_.push_back(std::move(record));
    if (open_object_ != nullptr)
        open_object_->push_back(records_.size() - 1);
    else
        placements_.push_back({records_.size() - 1, Transform()});
}

} // namespace keyhole::pbrt
