// The density with which light tracing makes a given light sub-path, as the power that it carries along it.
#pragma once

#include "sampling/guidance/guided_subpath.h"
#include "sampling/guidance/learned/learned_emission.h"
#include "scene/scene.h"

#include <optional>

namespace keyhole {

/// How light tracing makes light paths. What they point to must outlive this.
struct LightPathSampling {
    const LightGuides* user_paths = nullptr;  ///< that half of the light paths follow, where there are any
    const LearnedEmission* learned = nullptr; ///< where light paths begin if there are no user paths; null: by power

    bool guided() const { return user_paths != nullptr && !user_paths->empty(); }
    /// The learned emission that is in force, if there is any.
    const LearnedEmission* emission() const { return guided() ? nullptr : learned; }
};

/// F(X) / p(X) [W] of light sub-path X, vertices 0 to `last` of `path`: flux over the density of light tracing, every
/// way to make X summed: choice of emitter, place and direction, scattering, walks along user paths, survival of
/// roulette. That is the power with which light tracing arrives there. None where light tracing never makes X. Reads
/// points, BSDFs and events of the vertices only.
std::optional<Rgb> light_path_power(const Scene& scene, const LightPathSampling& sampling, const Path& path, int last);

} // namespace keyhole
