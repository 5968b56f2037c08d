// Materials of KHR_materials_pbrSpecularGlossiness, as metal or plastic.
#pragma once

#include "scene/load/gltf/document.h"
#include "scene/texture.h"

namespace keyhole::gltf {

struct MetallicRoughness {
    ColorTexture color;
    FloatTexture metallic, roughness;
};

/// What looks like the extension's diffuse and specular colours: place by place, the mix of a metal and of a dielectric
/// that reflects 4 % along its normal which has their brightness (as Khronos' own converter finds it).
MetallicRoughness from_specular_glossiness(Document& document, const Json& extension);

} // namespace keyhole::gltf
