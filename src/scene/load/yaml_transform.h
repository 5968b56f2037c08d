// Transforms in scene files.
#pragma once

#include "scene/load/geometry_transform.h"
#include "scene/load/yaml_tree.h"

namespace keyhole {

/// Reads one step (`{scale: s}`, `{scale: [x,y,z]}`, `{rotate: [degrees, x,y,z]}`, `{translate: [x,y,z]}`,
/// `{matrix: [16 numbers]}`), or a list of steps of which the first acts first. Rotations are anticlockwise seen
/// against their axis. Matrices stand row by row and act on columns, as in textbooks.
/// @throws InputError at the step that is wrong or singular.
Transform read_transform(const YamlNode& node);

} // namespace keyhole
