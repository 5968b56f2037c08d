// Where light paths begin and go on, learned once for all passes: whoever makes one of them makes the same photons.
#pragma once

#include "core/render_stats.h"
#include "methods/photons/photon_sampler.h"
#include "sampling/guidance/learned/learned_emission.h"
#include "sampling/guidance/learned/learned_scattering.h"

#include <optional>

namespace keyhole {

/// Light paths for each path that learns where they are to begin, and the bounds of these.
constexpr std::int64_t kPathsOfLearning = 16, kLeastLearning = 2048, kMostLearning = 1 << 16;

namespace stages {
inline constexpr Stage emission{.name = "emission",
                                .setting = &Settings::light_paths,
                                .least = kPathsOfLearning * kLeastLearning,
                                .most = kPathsOfLearning * kMostLearning,
                                .once = true};
} // namespace stages

/// Each none where it doesn't pay.
struct LearnedLightPaths {
    std::optional<LearnedEmission> emission;
    std::optional<LearnedScattering> scattering;

    const LearnedEmission* emission_or_null() const { return emission ? &*emission : nullptr; }
    const LearnedScattering* scattering_or_null() const { return scattering ? &*scattering : nullptr; }
};

/// From so many paths.
LearnedLightPaths learn_light_paths(const SamplerContext& context, std::int64_t paths, const RunContext& run);
/// From as many as a pass deserves, with a clock of its own.
LearnedLightPaths learn_light_paths(const SamplerContext& context, RenderStats& stats, const RunContext& run);

} // namespace keyhole
