// A picture without the grain that samples of pixels leave.
#pragma once

#include "core/progress.h"
#include "film/picture.h"

#include <cstddef>
#include <optional>

namespace keyhole {

/// Pixels up to which the filter looks, unless time is short.
constexpr int kDenoisingReach = 6;

/// The layer "beauty" without the noise that two halves of the samples differ in: direct light, and all other light,
/// each filtered by non-local means (filter_crosswise()) and blended with what it was by how far either is from the
/// other half, so that the more samples, the less is changed. What all samples share, such as the photons of a map,
/// stays as it is. The same for any number of threads.
/// @param picture with the layers of a Film and their noise.
/// @returns none for a picture without these, and if `stop` is requested meanwhile. May be null.
std::optional<Image> denoise(const Picture& picture, int reach = kDenoisingReach, const StopToken* stop = nullptr);

/// CPU time that denoise() takes for so many pixels [s], from a trial on a small picture that the first call makes.
double denoising_seconds(std::size_t pixels, int reach = kDenoisingReach);
/// The longest reach for which it takes at most so much CPU time [s]; 0: too little for any.
int denoising_reach(std::size_t pixels, double seconds);

} // namespace keyhole
