// Spectra of pbrt's format as RGB.
#pragma once

#include "core/vec.h"
#include "scene/load/pbrt/syntax/directive.h"
#include "scene/load/properties.h"

#include <string>

namespace keyhole::pbrt {

/// Wavelengths of red, green and blue [nm] where an index is read.
constexpr double kPrimaryWavelengths[3] = {630, 532, 465};

/// The value of an `rgb`, `xyz`, `blackbody` or `spectrum` parameter. Negative components, of colours that a screen
/// can't show, become 0.
/// @param directory of spectrum files.
/// @throws InputError for unknown names, broken files, and values that make no sense for the use.
Rgb read_spectrum(const Directive& directive, const Parameter& parameter, ColorUse use, const std::string& directory);

/// Colour of a black body [K], with luminance 1, by Planck's law.
Rgb blackbody_color(double kelvin);

} // namespace keyhole::pbrt
