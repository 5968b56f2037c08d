// Materials of glTF files.
#pragma once

#include "scene/load/gltf/document.h"
#include "scene/load/gltf/vertex_colors.h"
#include "scene/shape.h"

namespace keyhole::gltf {

/// What shapes get from an entry of `materials`.
struct MaterialData {
    MaterialPtr material;
    SurfaceEmission emission;             ///< black: none
    FloatTexture alpha;                   ///< null: opaque
    std::shared_ptr<const Medium> inside; ///< of closed meshes; null: vacuum
};

/// The material of an entry of `materials`, or the one of meshes that name none, on a mesh with such colours.
MaterialData read_material(Document& document, const Json& material, const VertexColors& colors);

} // namespace keyhole::gltf
