#include "methods/photons/trials/light_trial.h"

#include "core/shared_work.h"
#include "methods/photons/radii.h"
#include "photonmap/importance/importance_guide.h"
#include "photonmap/importance/importance_tracing.h"
#include "sampling/brightness.h"
#include "sampling/guidance/guided_light.h"
#include "session/passes.h"

#include <algorithm>
#include <atomic>

namespace keyhole {
namespace {

constexpr std::int64_t kPathsOfBlock = 64; // light paths

/// How much is tried: less where the render itself will be short.
struct Extent {
    std::int64_t importons, light_paths, brightness_samples;

    explicit Extent(const Settings& s) {
        const std::int64_t work = std::min<std::int64_t>(std::max(s.light_paths, s.mutations), 500'000);
        const auto part = [&](std::int64_t most) { return std::max(most * work / 500'000, most / 8); };
        importons = part(50'000);
        light_paths = part(32'768);
        brightness_samples = part(32'768);
    }
};

/// Whether a light path left a photon where importons are.
struct VisiblePower {
    const ImportanceGuide& global;
    const ImportanceGuide& caustic;
    StorageRule rule;
    bool found = false;

    bool arrival(Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast& past) {
        if (!v.bsdf.traits().finite) return true;
        const StorageRule::Kinds kinds = rule(v, to_light, past);
        found |= kinds.global && global.visible_power(v, to_light, power).value_or(0) > 0;
        found |= kinds.caustic && caustic.visible_power(v, to_light, power).value_or(0) > 0;
        return !found;
    }
};

/// As if no wall stood between photons and importons.
bool light_comes_near(const SamplerContext& c, const Extent& extent, const RunContext& run) {
    const auto depth = static_cast<int>(c.settings.max_depth);
    const std::uint64_t seed = seed_of_trial(c.settings);
    Importons importons = trace_importance(c.scene, c.importance_tracing(extent.importons, seed), run);
    const float radius = Radii(c.scene).importance;
    const ImportanceGuide global(PhotonMap(std::move(importons.second)), radius, c.patches, nullptr, run);
    const ImportanceGuide caustic(PhotonMap(std::move(importons.first)), radius, c.patches, nullptr, run);
    const LightGuides user_paths(c.scene, c.user_paths);
    std::atomic<bool> found = false;
    parallel_blocks(extent.light_paths, kPathsOfBlock, run, [&](std::int64_t i) {
        if (found) return;
        Rng rng(seed, StreamPurpose::emission, static_cast<std::uint64_t>(i));
        VisiblePower sink{global, caustic, c.storage()};
        trace_light_path(c.scene, {&user_paths, nullptr}, depth, rng, sink);
        if (sink.found) found = true;
    });
    return found;
}

bool stage_one_finds_light(const SamplerContext& c, const Extent& extent, const RunContext& run) {
    const auto depth = static_cast<int>(c.settings.max_depth);
    const PathSet set{.coverage = c.coverage, .weight = c.weight};
    const GuidedPaths guides(c.scene, c.user_paths, set, depth);
    const StageOneSettings first{.set = set,
                                 .max_scatterings = depth,
                                 .samples = extent.brightness_samples,
                                 .seed = seed_of_trial(c.settings),
                                 .guides = c.user_paths.empty() ? nullptr : &guides};
    return run_stage_one(c.scene, first, run).brightness.mean() > 0;
}

} // namespace

bool may_be_lit(const SamplerContext& context, const RunContext& run) {
    const Extent extent(context.settings);
    return light_comes_near(context, extent, run) || stage_one_finds_light(context, extent, run);
}

} // namespace keyhole
