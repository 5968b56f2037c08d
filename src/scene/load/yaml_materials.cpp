#include "scene/load/yaml_materials.h"

#include "scene/load/suggest.h"
#include "scene/load/yaml_reader.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

using Reader = std::shared_ptr<const Material> (*)(const YamlNode&);

std::shared_ptr<const Material> read_diffuse(const YamlNode& node) {
    const MapReader map(node, "a diffuse material", {"type", "reflectance"});
    return make_diffuse(map.color("reflectance", kReflectance, Rgb(0.5)));
}

std::shared_ptr<const Material> read_mirror(const YamlNode& node) {
    const MapReader map(node, "a mirror", {"type", "reflectance"});
    return make_mirror(map.color("reflectance", kReflectance, Rgb(1.0)));
}

std::shared_ptr<const Material> read_glass(const YamlNode& node) {
    constexpr NumberRange kIor{"a refractive index", 0.01, 100};
    constexpr NumberRange kTint{"a tint", 0, 1};
    const MapReader map(node, "glass", {"type", "ior", "reflect_tint", "transmit_tint"});
    return make_glass(map.number("ior", kIor, 1.5), map.color("reflect_tint", kTint, Rgb(1.0)),
                      map.color("transmit_tint", kTint, Rgb(1.0)));
}

const std::map<std::string_view, Reader>& readers() {
    static const std::map<std::string_view, Reader> table{
        {"diffuse", read_diffuse}, {"mirror", read_mirror}, {"glass", read_glass}};
    return table;
}

std::shared_ptr<const Material> read_material(const YamlNode& node) {
    std::vector<std::string_view> types;
    for (const auto& [type, reader] : readers()) types.push_back(type);
    return readers().at(read_type(node, "a material", types))(node);
}

} // namespace

void MaterialTable::read(const YamlNode& section) {
    for (const auto& [key, value] : read_names(section, "materials")) {
        const auto [entry, fresh] = materials_.try_emplace(key->text, Named{read_material(*value), key->position()});
        if (!fresh)
            fail(*key, fmt::format("found the material '{}' again, expected another name (first at {})", key->text,
                                   entry->second.position.to_string()));
    }
}

std::shared_ptr<const Material> MaterialTable::resolve(const YamlNode& node) const {
    if (node.kind == YamlNode::Kind::map) return read_material(node);
    const std::string name = read_string(node, "the name of a material");
    if (const auto found = materials_.find(name); found != materials_.end()) return found->second.material;
    std::vector<std::string_view> names;
    for (const auto& [other, material] : materials_) names.push_back(other);
    fail(node, fmt::format("found the unknown material '{}', {}", name, expected_one_of(name, names)));
}

} // namespace keyhole
