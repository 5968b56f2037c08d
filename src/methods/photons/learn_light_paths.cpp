#include "methods/photons/learn_light_paths.h"

#include "session/stage_clock.h"

#include <algorithm>

namespace keyhole {
namespace {

constexpr std::size_t kMemoryOfLearning = 5;

} // namespace

LearnedLightPaths learn_light_paths(const SamplerContext& c, std::int64_t paths, const RunContext& run) {
    LearnedLightPaths learned;
    if (!LearnedEmission::can_learn(c.scene)) return learned;
    FoundLightPaths found =
        look_for_light(c.scene,
                       {.paths = paths,
                        .max_scatterings = static_cast<int>(c.settings.max_depth),
                        .set = c.path_set(),
                        .seed = c.settings.seed,
                        .most_bytes = static_cast<std::size_t>(c.settings.photon_memory) / kMemoryOfLearning},
                       run);
    learned.emission.emplace(c.scene, std::move(found.ends));
    if (!c.user_paths.empty()) return learned; // along which light goes on as they say
    learned.scattering.emplace(found.scatterings);
    if (!learned.scattering->helps()) learned.scattering.reset();
    return learned;
}

LearnedLightPaths learn_light_paths(const SamplerContext& c, RenderStats& stats, const RunContext& run) {
    if (!LearnedEmission::can_learn(c.scene)) return {};
    const StageClock clock(stats, stages::emission);
    LearnedLightPaths learned =
        learn_light_paths(c, std::clamp(c.settings.light_paths / kPathsOfLearning, kLeastLearning, kMostLearning), run);
    stats.values["emitters that matter"] = learned.emission->effective_emitters();
    stats.values["light scattered as it was learned"] = learned.scattering ? learned.scattering->helped_share() : 0;
    stats.values["learned_light_paths_bytes"] =
        static_cast<double>(learned.emission->bytes() + (learned.scattering ? learned.scattering->bytes() : 0));
    return learned;
}

} // namespace keyhole
