// Textures in scene files.
#pragma once

#include "scene/load/yaml_reader.h"
#include "scene/texture.h"

namespace keyhole {

/// A colour, or a map that describes a texture. @throws InputError for mistakes, among them files that can't be read.
ColorTexture read_color_texture(const YamlNode& node, const NumberRange& range);

/// A number, or a map that describes a texture.
FloatTexture read_float_texture(const YamlNode& node, const NumberRange& range);

/// The texture under a key of a map, or `otherwise` everywhere.
ColorTexture color_texture(const MapReader& map, std::string_view key, const NumberRange& range, const Rgb& otherwise);
FloatTexture float_texture(const MapReader& map, std::string_view key, const NumberRange& range, double otherwise);

} // namespace keyhole
