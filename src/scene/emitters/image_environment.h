// Light from a picture of all directions.
#pragma once

#include "scene/emitter.h"
#include "scene/emitters/sphere_map.h"

#include <string>

namespace keyhole {

/// Radiance from each direction.
struct EnvironmentImage {
    int width = 0, height = 0;  ///< an octahedral picture is square
    std::vector<Vec3> radiance; ///< [W/(m^2 sr)] row by row from the top; each pixel is constant
    SphereLayout layout = SphereLayout::lat_long;
};

/// Reads the pixels of an image file: floats as radiance, integers as sRGB.
/// @throws InputError for a file that can't be read, and for radiance that is negative or not finite.
EnvironmentImage read_environment_image(const std::string& path, SphereLayout layout);

/// The light of `image` times `scale`. Directions are drawn in proportion to the luminance of the pixels, uniform
/// within one: density and radiance have their steps at the same places.
/// @param to_world turns the directions of the picture into the world's; a rotation, mirrored or not.
/// @throws InputError for a picture that is black or of the wrong shape, and for other transforms.
std::unique_ptr<Emitter> make_image_environment(EnvironmentImage image, const Rgb& scale, const Imath::M33d& to_world);

} // namespace keyhole
