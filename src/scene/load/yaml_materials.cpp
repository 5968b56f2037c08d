#include "scene/load/yaml_materials.h"

#include "scene/load/suggest.h"
#include "scene/load/yaml_reader.h"
#include "scene/load/yaml_textures.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

constexpr NumberRange kIor{"a refractive index", 0.01, 100};
constexpr NumberRange kAlpha{"a roughness", 0, 1};
constexpr NumberRange kThickness{"an optical depth", 0, 1000};

using Reader = MaterialPtr (*)(const YamlNode&, const MaterialTable&);

struct Roughness {
    FloatTexture x, y;
};

/// A number or texture for both directions, or a list of one for each.
Roughness read_roughness(const MapReader& map, std::string_view key) {
    const YamlNode* node = map.find(key);
    if (node == nullptr || node->kind != YamlNode::Kind::list) {
        const FloatTexture both = float_texture(map, key, kAlpha, 0);
        return {both, both};
    }
    if (node->items.size() != 2) fail_expected(*node, "a roughness, or two: along the tangent and across it");
    return {read_float_texture(*node->items[0], kAlpha), read_float_texture(*node->items[1], kAlpha)};
}

MaterialPtr read_black(const YamlNode& node, const MaterialTable& /*table*/) {
    const MapReader map(node, "a black material", {"type", "bump"});
    return make_black();
}

MaterialPtr read_diffuse(const YamlNode& node, const MaterialTable& /*table*/) {
    const MapReader map(node, "a diffuse material", {"type", "reflectance", "bump"});
    return make_diffuse(color_texture(map, "reflectance", kReflectance, Rgb(0.5)));
}

MaterialPtr read_diffuse_transmission(const YamlNode& node, const MaterialTable& /*table*/) {
    const MapReader map(node, "a translucent material", {"type", "reflectance", "transmittance", "bump"});
    return make_diffuse_transmission(color_texture(map, "reflectance", kReflectance, Rgb(0.25)),
                                     color_texture(map, "transmittance", kReflectance, Rgb(0.25)));
}

MaterialPtr read_mirror(const YamlNode& node, const MaterialTable& /*table*/) {
    const MapReader map(node, "a mirror", {"type", "reflectance", "bump"});
    return make_mirror(map.color("reflectance", kReflectance, Rgb(1.0)));
}

MaterialPtr read_glass(const YamlNode& node, const MaterialTable& /*table*/) {
    constexpr NumberRange kTint{"a tint", 0, 1};
    const MapReader map(node, "glass", {"type", "ior", "reflect_tint", "transmit_tint", "bump"});
    return make_glass(map.number("ior", kIor, 1.5), map.color("reflect_tint", kTint, Rgb(1.0)),
                      map.color("transmit_tint", kTint, Rgb(1.0)));
}

MaterialPtr read_dielectric(const YamlNode& node, const MaterialTable& /*table*/) {
    const MapReader map(node, "a dielectric", {"type", "ior", "roughness", "bump"});
    const Roughness rough = read_roughness(map, "roughness");
    return make_dielectric(map.number("ior", kIor, 1.5), rough.x, rough.y);
}

MaterialPtr read_thin_dielectric(const YamlNode& node, const MaterialTable& /*table*/) {
    const MapReader map(node, "a pane", {"type", "ior", "bump"});
    return make_thin_dielectric(map.number("ior", kIor, 1.5));
}

MaterialPtr read_interface(const YamlNode& node, const MaterialTable& /*table*/) {
    const MapReader map(node, "an interface", {"type"});
    return make_interface();
}

/// Calls `make` with what a metal is described by: its complex index, or its reflectance.
template <class Make> MaterialPtr read_metal(const YamlNode& node, const MapReader& map, Make&& make) {
    constexpr NumberRange kIndex{"a part of a complex index", 0, 1000};
    const YamlNode *eta = map.find("eta"), *k = map.find("k");
    if ((eta == nullptr) != (k == nullptr))
        fail(node, fmt::format("found '{}' alone, expected 'eta' and 'k', or 'reflectance'", eta ? "eta" : "k"));
    if (eta != nullptr && map.find("reflectance") != nullptr)
        fail(node, "found 'reflectance' beside 'eta' and 'k', expected one or the other");
    if (eta != nullptr) return make(read_color(*eta, kIndex), read_color(*k, kIndex));
    return make(color_texture(map, "reflectance", kReflectance, Rgb(0.9)));
}

MaterialPtr read_conductor(const YamlNode& node, const MaterialTable& /*table*/) {
    const MapReader map(node, "a conductor", {"type", "reflectance", "eta", "k", "roughness", "bump"});
    const Roughness rough = read_roughness(map, "roughness");
    return read_metal(node, map, [&](const auto&... metal) { return make_conductor(metal..., rough.x, rough.y); });
}

MaterialPtr read_coated_diffuse(const YamlNode& node, const MaterialTable& /*table*/) {
    const MapReader map(node, "a coated material", {"type", "reflectance", "ior", "roughness", "thickness", "bump"});
    const Roughness rough = read_roughness(map, "roughness");
    return make_coated_diffuse(color_texture(map, "reflectance", kReflectance, Rgb(0.5)), rough.x, rough.y,
                               map.number("ior", kIor, 1.5), float_texture(map, "thickness", kThickness, 0));
}

MaterialPtr read_coated_conductor(const YamlNode& node, const MaterialTable& /*table*/) {
    const MapReader map(node, "a coated conductor",
                        {"type", "reflectance", "eta", "k", "roughness", "ior", "coat_roughness", "thickness", "bump"});
    const Roughness rough = read_roughness(map, "roughness"), coat = read_roughness(map, "coat_roughness");
    const Coat varnish{map.number("ior", kIor, 1.5), coat.x, coat.y, float_texture(map, "thickness", kThickness, 0)};
    return read_metal(node, map,
                      [&](const auto&... metal) { return make_coated_conductor(varnish, metal..., rough.x, rough.y); });
}

MaterialPtr read_mix(const YamlNode& node, const MaterialTable& table) {
    constexpr NumberRange kShare{"a share", 0, 1};
    const MapReader map(node, "a mix of materials", {"type", "a", "b", "amount", "bump"});
    return make_mix(table.resolve(map.at("a")), table.resolve(map.at("b")), float_texture(map, "amount", kShare, 0.5));
}

const std::map<std::string_view, Reader>& readers() {
    static const std::map<std::string_view, Reader> table{{"black", read_black},
                                                          {"coated_conductor", read_coated_conductor},
                                                          {"coated_diffuse", read_coated_diffuse},
                                                          {"conductor", read_conductor},
                                                          {"dielectric", read_dielectric},
                                                          {"diffuse", read_diffuse},
                                                          {"diffuse_transmission", read_diffuse_transmission},
                                                          {"glass", read_glass},
                                                          {"interface", read_interface},
                                                          {"mirror", read_mirror},
                                                          {"mix", read_mix},
                                                          {"thin_dielectric", read_thin_dielectric}};
    return table;
}

MaterialPtr read_material(const YamlNode& node, const MaterialTable& table) {
    std::vector<std::string_view> types;
    for (const auto& [type, reader] : readers()) types.push_back(type);
    MaterialPtr material = readers().at(read_type(node, "a material", types))(node, table);
    const YamlNode* bump = MapReader(node, "a material").find("bump");
    return bump != nullptr ? with_bump(material, read_float_texture(*bump, kCoordinate)) : material;
}

} // namespace

void MaterialTable::read(const YamlNode& section, Mistakes& mistakes) {
    for (const YamlNode::Entry& entry : read_names(section, "materials"))
        mistakes.attempt_definition([&] { add(*entry.key, *entry.value); });
}

void MaterialTable::add(const YamlNode& key, const YamlNode& value) {
    const auto [entry, fresh] = materials_.try_emplace(key.text, Named{read_material(value, *this), key.position()});
    if (!fresh)
        fail(key, fmt::format("found the material '{}' again, expected another name (first at {})", key.text,
                              entry->second.position.to_string()));
}

std::shared_ptr<const Material> MaterialTable::resolve(const YamlNode& node) const {
    if (node.kind == YamlNode::Kind::map) return read_material(node, *this);
    const std::string name = read_string(node, "the name of a material");
    if (const auto found = materials_.find(name); found != materials_.end()) return found->second.material;
    std::vector<std::string_view> names;
    for (const auto& [other, material] : materials_) names.push_back(other);
    fail_unknown(node, fmt::format("material '{}'", name),
                 fmt::format("found the unknown material '{}', {}", name, expected_one_of(name, names)));
}

} // namespace keyhole
