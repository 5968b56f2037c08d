#include "scene/load/yaml_media.h"

#include "scene/load/suggest.h"
#include "scene/load/yaml_reader.h"

#include <fmt/format.h>

namespace keyhole {

void MediumTable::read(const YamlNode& section, Mistakes& mistakes) {
    for (const YamlNode::Entry& entry : read_names(section, "media"))
        mistakes.attempt_definition([&] { add(*entry.key, *entry.value); });
}

void MediumTable::add(const YamlNode& key, const YamlNode& value) {
    constexpr NumberRange kAbsorption{"an absorption coefficient", 0, 1e30};
    const MapReader map(value, "a medium", {"absorption"});
    auto medium = std::make_shared<const Medium>(Medium{read_color(map.at("absorption"), kAbsorption)});
    const auto [entry, fresh] = media_.try_emplace(key.text, Named{std::move(medium), key.position()});
    if (!fresh)
        fail(key, fmt::format("found the medium '{}' again, expected another name (first at {})", key.text,
                              entry->second.position.to_string()));
}

std::shared_ptr<const Medium> MediumTable::resolve(const YamlNode& node) const {
    const std::string name = read_string(node, "the name of a medium");
    if (const auto found = media_.find(name); found != media_.end()) return found->second.medium;
    std::vector<std::string_view> names;
    for (const auto& [other, medium] : media_) names.push_back(other);
    fail_unknown(node, fmt::format("medium '{}'", name),
                 fmt::format("found the unknown medium '{}', {}", name, expected_one_of(name, names)));
}

} // namespace keyhole
