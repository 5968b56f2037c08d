// The density with which light tracing makes a given light sub-path, as the power that it carries along it.
#pragma once

#include "sampling/guidance/guided_light.h"

#include <optional>

namespace keyhole {

/// F(X) / p(X) [W] of light sub-path X, vertices 0 to `last` of `path`: flux over the density of light tracing, every
/// way to make X summed: choice of emitter, place and direction, scattering, walks along user paths, survival of
/// roulette. That is the power with which light tracing arrives there. None where light tracing never makes X. Reads
/// points, BSDFs and events of the vertices only.
std::optional<Rgb> light_path_power(const Scene& scene, const LightPathSampling& sampling, const Path& path, int last);

} // namespace keyhole
