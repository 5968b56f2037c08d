// Materials, emitters, textures and transforms in scene files.
#pragma once

#include "scene/load/load_mesh.h"
#include "scene/load/properties.h"
#include "scene/load/yaml/named_table.h"
#include "scene/load/yaml/reader.h"

#include <string>

namespace keyhole {

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
