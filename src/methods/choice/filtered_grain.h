// What the filter at the end has to do with choosing.
#pragma once

#include "methods/method.h"

namespace keyhole {

/// The share of the grain of a method's samples that the filter at the end leaves, where the picture that counts goes
/// through it: between a twentieth and a half on scenes that others made (docs/denoise.md). Blotches stay, and so does
/// what chains draw.
inline double grain_that_counts(const Settings& settings, const Method& method) {
    constexpr double kLeft = 0.3;
    return settings.denoise == Denoise::exr && (method.samples_pixels || method.keeps_photons) ? kLeft : 1;
}

} // namespace keyhole
