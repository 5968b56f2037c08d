// Materials, emitters, textures and transforms in scene files.
#pragma once

#include "scene/load/input.h"
#include "scene/load/load_mesh.h"
#include "scene/load/properties.h"
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

/// The named materials of a scene and its includes.
using MaterialTable = NamedTable<MaterialPtr>;

/// The material that a node describes; parts of it may be those of `table`.
/// @throws InputError for mistakes and unknown names, with their positions, as the next ones do.
MaterialPtr read_material(const YamlNode& node, const MaterialTable& table);

/// The material that a node names or describes.
MaterialPtr find_material(const YamlNode& node, const MaterialTable& table);

/// An item of an `emitters:` section. Null for one that is black.
EmitterPtr read_emitter(const YamlNode& node);

/// The emission of a shape with that area; null where nothing is emitted.
std::unique_ptr<SurfaceEmission> read_emission(const YamlNode& node, double area);

/// A number, or a map that describes a texture.
FloatTexture read_float_texture(const YamlNode& node, const NumberRange& range);

/// A path in a scene file: relative to the directory of that file.
std::string resolve_path(const YamlNode& node, std::string_view expected);

/// Reads one step (`{scale: s}`, `{scale: [x,y,z]}`, `{rotate: [degrees, x,y,z]}`, `{translate: [x,y,z]}`,
/// `{matrix: [16 numbers]}`), or a list of steps of which the first acts first. Rotations are anticlockwise seen
/// against their axis. Matrices stand row by row and act on columns, as in textbooks.
/// @throws InputError at the step that is wrong or singular.
Transform read_transform(const YamlNode& node);

} // namespace keyhole
