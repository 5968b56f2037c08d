// Colours and opacities that meshes of glTF files give their vertices.
#pragma once

#include "scene/load/load_mesh.h"
#include "scene/texture.h"

namespace keyhole::gltf {

/// Factors on what the material of a mesh says of its base colour; null: none.
struct VertexColors {
    ColorTexture color;
    FloatTexture opacity;
};

/// The colours of a part of a file, linear across triangles. They hold for points of a shape with the same triangles.
VertexColors vertex_colors(const MeshPart& part);

} // namespace keyhole::gltf
