#include "scene/load/yaml_emitters.h"

#include "core/error.h"
#include "scene/emitters/distant.h"
#include "scene/emitters/environment.h"
#include "scene/emitters/image_environment.h"
#include "scene/emitters/point.h"
#include "scene/emitters/spot.h"
#include "scene/load/yaml_primitives.h"
#include "scene/load/yaml_reader.h"
#include "scene/load/yaml_transform.h"

#include <fmt/format.h>

#include <map>

namespace keyhole {
namespace {

using EmitterPtr = std::unique_ptr<Emitter>;

Vec3 read_direction(const YamlNode& node) {
    const Imath::V3d w = read_vec3(node, kCoordinate);
    if (!(w.length() > 0)) fail(node, "found the direction [0, 0, 0], expected one that leads somewhere");
    return Vec3(w.normalized());
}

/// The one of two keys that is given.
const YamlNode& read_either(const YamlNode& node, const MapReader& map, std::string_view a, std::string_view b) {
    const YamlNode *first = map.find(a), *second = map.find(b);
    if ((first == nullptr) == (second == nullptr))
        fail(node, fmt::format("found {} of '{}' and '{}', expected one", first ? "both" : "neither", a, b));
    return first != nullptr ? *first : *second;
}

/// Radiant intensity [W/sr] of a point that shines into `solid_angle`, given as such or by its power.
Rgb read_intensity(const YamlNode& node, const MapReader& map, double solid_angle) {
    const Rgb value = read_color(read_either(node, map, "intensity", "power"), kLight);
    return map.find("power") != nullptr ? value / solid_angle : value;
}

EmitterPtr read_point(const YamlNode& node) {
    const MapReader map(node, "a point emitter", {"type", "position", "intensity", "power"});
    const Imath::V3d position = read_vec3(map.at("position"), kCoordinate);
    const Rgb intensity = read_intensity(node, map, 4 * kPi);
    if (is_black(intensity)) return nullptr;
    return make_point_emitter(Vec3(position), intensity);
}

EmitterPtr read_spot(const YamlNode& node) {
    const MapReader map(node, "a spot emitter",
                        {"type", "position", "to", "direction", "angle", "falloff", "intensity", "power"});
    SpotParameters spot;
    const Imath::V3d position = read_vec3(map.at("position"), kCoordinate);
    spot.position = Vec3(position);
    const YamlNode& aim = read_either(node, map, "to", "direction");
    if (map.find("to") != nullptr) {
        const Imath::V3d axis = read_vec3(aim, kCoordinate) - position;
        if (!(axis.length() > 0)) fail(aim, "found 'to' at the position, expected another point");
        spot.axis = Vec3(axis.normalized());
    } else {
        spot.axis = read_direction(aim);
    }
    constexpr NumberRange kAngle{"an angle from the axis", 0.1, 180};
    spot.edge_degrees = map.number("angle", kAngle, 30);
    const NumberRange falloff{"an angle up to 'angle'", 0, spot.edge_degrees};
    spot.full_degrees = spot.edge_degrees - map.number("falloff", falloff, std::min(5.0, spot.edge_degrees));
    spot.intensity = read_intensity(node, map, spot_solid_angle(spot));
    if (is_black(spot.intensity)) return nullptr;
    return make_spot_emitter(spot);
}

EmitterPtr read_distant(const YamlNode& node) {
    const MapReader map(node, "a distant emitter", {"type", "direction", "irradiance"});
    const Vec3 w = read_direction(map.at("direction"));
    const Rgb irradiance = read_color(map.at("irradiance"), kLight);
    if (is_black(irradiance)) return nullptr;
    return make_distant_emitter(w, irradiance);
}

Imath::M33d read_rotation(const YamlNode& node) {
    const Transform t = read_transform(node);
    return {t[0][0], t[0][1], t[0][2], t[1][0], t[1][1], t[1][2], t[2][0], t[2][1], t[2][2]};
}

EmitterPtr read_environment(const YamlNode& node) {
    const MapReader map(node, "an environment", {"type", "radiance", "image", "layout", "transform"});
    const Rgb radiance = map.color("radiance", kLight, Rgb(1.0));
    const YamlNode* image = map.find("image");
    for (const char* key : {"layout", "transform"})
        if (image == nullptr && map.find(key) != nullptr)
            fail(node, fmt::format("found '{}' without 'image', expected both or neither", key));
    if (is_black(radiance)) return nullptr;
    if (image == nullptr) return make_constant_environment(radiance);
    auto layout = SphereLayout::lat_long;
    if (const YamlNode* name = map.find("layout"))
        if (read_choice(*name, "a layout", {"lat_long", "octahedral"}) == "octahedral")
            layout = SphereLayout::octahedral;
    const YamlNode* transform = map.find("transform");
    const Imath::M33d to_world = transform != nullptr ? read_rotation(*transform) : Imath::M33d();
    const std::string path = resolve_path(*image, "the path of a picture");
    try {
        return make_image_environment(read_environment_image(path, layout), radiance, to_world);
    } catch (const InputError& e) {
        fail(*image, e.what());
    }
}

} // namespace

EmitterPtr read_emitter(const YamlNode& node) {
    static const std::map<std::string_view, EmitterPtr (*)(const YamlNode&)> readers{
        {"point", read_point}, {"spot", read_spot}, {"distant", read_distant}, {"environment", read_environment}};
    std::vector<std::string_view> types;
    types.reserve(readers.size());
    for (const auto& [type, reader] : readers) types.push_back(type);
    return readers.at(read_type(node, "an emitter", types))(node);
}

} // namespace keyhole
