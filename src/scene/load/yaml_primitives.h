// Rectangles, boxes, spheres and mesh files in scene files, before their transforms.
#pragma once

#include "scene/load/geometry_transform.h"
#include "scene/load/yaml_tree.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

/// Meshes already imported, by path.
using MeshCache = std::map<std::string, TriangleMesh>;

/// The values of `type` that read_geometry() knows.
const std::vector<std::string_view>& geometry_types();

/// The geometry of a shape of a known type, in its own space. @throws InputError for mistakes and bad mesh files.
Geometry read_geometry(const std::string& type, const YamlNode& node, MeshCache& meshes);

/// A path in a scene file: relative to the directory of that file.
std::string resolve_path(const YamlNode& node, std::string_view expected);

} // namespace keyhole
