// Materials of KHR_materials_pbrSpecularGlossiness, as metal or plastic.
#pragma once

#include "scene/load/gltf/document.h"
#include "scene/texture.h"

namespace keyhole::gltf {

struct MetallicRoughness {
    ColorTexture color;
    FloatTexture metallic, roughness;
    FloatTexture specular{}; ///< reflectance along the normal where it is no metal; null: by its index
};

/// What looks like the extension's diffuse and specular colours, place by place. Where the latter is grey that is a
/// dielectric which reflects as much; else the mix of a metal and of a dielectric that reflects 4 % which has their
/// brightness, as Khronos' own converter finds it.
MetallicRoughness from_specular_glossiness(Document& document, const Json& extension);

} // namespace keyhole::gltf
