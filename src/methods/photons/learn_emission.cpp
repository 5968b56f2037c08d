#include "methods/photons/learn_emission.h"

#include "session/stage_clock.h"

#include <algorithm>

namespace keyhole {
namespace {

/// Light paths for each path that learns where they are to begin, and the bounds of these.
constexpr std::int64_t kPathsOfLearning = 16, kLeastPaths = 2048, kMostPaths = 1 << 16;
constexpr std::size_t kMemoryOfLearning = 10;

} // namespace

std::optional<LearnedEmission> learn_emission(const SamplerContext& c, std::int64_t paths, const RunContext& run) {
    if (!LearnedEmission::can_learn(c.scene)) return std::nullopt;
    return std::optional<LearnedEmission>(
        std::in_place, c.scene,
        EmissionLearning{.paths = paths,
                         .max_scatterings = static_cast<int>(c.settings.max_depth),
                         .set = c.path_set(),
                         .seed = static_cast<std::uint64_t>(c.settings.seed),
                         .most_bytes = static_cast<std::size_t>(c.settings.photon_memory) / kMemoryOfLearning},
        run);
}

std::optional<LearnedEmission> learn_emission(const SamplerContext& c, RenderStats& stats, const RunContext& run) {
    if (!LearnedEmission::can_learn(c.scene)) return std::nullopt;
    const StageClock clock(stats, stages::emission);
    auto learned =
        learn_emission(c, std::clamp(c.settings.light_paths / kPathsOfLearning, kLeastPaths, kMostPaths), run);
    stats.values["emitters that matter"] = learned->effective_emitters();
    return learned;
}

} // namespace keyhole
