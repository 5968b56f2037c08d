// Materials of glTF files.
#pragma once

#include "scene/load/gltf/document.h"
#include "scene/shape.h"

namespace keyhole::gltf {

/// What a material says of the shapes that have it.
struct Look {
    MaterialPtr material;
    SurfaceEmission emission; ///< black: none
    FloatTexture alpha;       ///< null: opaque
};

/// The material of an entry of `materials`, or the one of meshes that name none.
Look read_look(Document& document, const Json& material);

} // namespace keyhole::gltf
