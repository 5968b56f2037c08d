#include "scene/load/input.h"
#include "scene/load/pbrt/importer.h"

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
    const auto& records = d.look_up(objects_, "object", d.words[0]);
    if (placements_.size() + records.size() > kMaxShapes)
        d.stop(fmt::format("found more than {} shapes, expected fewer", kMaxShapes));
    ++instances_;
    for (const std::size_t record : records) placements_.push_back({record, state_.to_world, instances_});
}

void Importer::define_texture(const Directive& d) {
    Parameters p = parameters(d, "texture");
    pbrt::define_texture(p, library_, state_.to_world);
}

void Importer::define_material(const Directive& d) {
    Parameters p = parameters(d, "material");
    pbrt::define_material(p, library_);
}

void Importer::define_medium(const Directive& d) {
    Parameters p = parameters(d, "medium");
    pbrt::define_medium(p, library_, state_.to_world);
}

void Importer::use_material(const Directive& d) {
    Parameters p = parameters(d, "material");
    state_.material = read_material(d.words[0], p, library_);
    state_.material_name.clear();
}

void Importer::use_named_material(const Directive& d) {
    state_.material_name = d.words[0];
    state_.named_by = std::make_shared<const Directive>(d.head());
}

void Importer::use_media(const Directive& d) {
    state_.inside_medium = d.words.front();
    state_.outside_medium = d.words.back();
}

void Importer::add_area_light(const Directive& d) {
    Parameters p = parameters(d, "light");
    state_.area_light = read_area_light(p, library_, view_.exposure);
}

void Importer::add_light(const Directive& d) {
    Parameters p = parameters(d, "light");
    EmitterPtr light = read_light(p, library_, state_.to_world, view_.exposure);
    if (light) (is_environment(*light) ? environments_ : emitters_).push_back(std::move(light));
}

void Importer::add_shape(const Directive& d) {
    Parameters p = parameters(d, "shape");
    ShapeRecord record;
    record.source = read_shape(p);
    record.directive = d.head();
    record.to_world = state_.to_world;
    record.reversed = state_.reversed;
    record.material = state_.material;
    record.material_name = state_.material_name;
    record.named_by = state_.named_by;
    record.light = state_.area_light;
    record.alpha = find_number_texture(p, library_, "alpha", kShare);
    p.ignore({"shadowalpha"}); // v3: what shadow rays see; here as all rays
    p.warn_of_the_rest();
    if (open_object_ != nullptr && record.light) {
        p.warn("light in object", "the area light is ignored, as pbrt does in objects");
        record.light.reset();
    }
    record.inside = find_medium(library_, state_.inside_medium, d);
    record.outside = find_medium(library_, state_.outside_medium, d);
    if (add_to_last(record)) return;
    records_.push_back(std::move(record));
    last_object_ = open_object_;
    if (open_object_ != nullptr)
        open_object_->push_back(records_.size() - 1);
    else
        placements_.push_back({records_.size() - 1, Transform()});
}

/// Hair comes as tens of thousands of directives, one for each curve: those that look alike become one shape. False:
/// the record is no curve, or not like the last one.
bool Importer::add_to_last(const ShapeRecord& record) {
    if (record.source.curves.curves.empty() || records_.empty() || open_object_ != last_object_) return false;
    ShapeRecord& last = records_.back();
    if (last.source.curves.curves.empty() || !look_alike(last, record)) return false;
    last.source.curves.append(record.source.curves);
    return true;
}

} // namespace keyhole::pbrt
