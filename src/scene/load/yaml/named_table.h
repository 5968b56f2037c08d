// What sections of a scene file give names to.
#pragma once

#include "scene/load/input.h"
#include "scene/load/yaml/reader.h"

#include <fmt/format.h>

#include <map>
#include <string>

namespace keyhole {

/// Values by their names, each with the place where it got it.
template <class T> class NamedTable {
  public:
    /// @param what one of them is, in messages: "material"
    explicit NamedTable(std::string_view what) : what_(what) {}

    /// Adds read(node) for each entry of a section; `names` as in "materials". Notes mistakes, and names already taken.
    template <class Read> void read(const YamlNode& section, std::string_view names, Mistakes& mistakes, Read&& read) {
        for (const auto& [key, value] : read_names(section, names))
            mistakes.attempt_definition([&, &key = *key, &value = *value] { add(key, read(value)); });
    }

    /// What a node names. @throws UnknownName.
    const T& resolve(const YamlNode& node) const {
        const std::string name = read_string(node, fmt::format("the name of a {}", what_));
        if (const auto found = named_.find(name); found != named_.end()) return found->second.value;
        throw UnknownName(node.position(), fmt::format("{} '{}'", what_, name), unknown_name(what_, name, named_));
    }

  private:
    void add(const YamlNode& key, T value) {
        const auto [entry, fresh] = named_.try_emplace(key.text, Entry{std::move(value), key.position()});
        if (!fresh)
            fail(key, fmt::format("found the {} '{}' again, expected another name (first at {})", what_, key.text,
                                  entry->second.position.to_string()));
    }

    struct Entry {
        T value;
        FilePosition position;
    };
    std::string_view what_;
    std::map<std::string, Entry> named_;
};

} // namespace keyhole
