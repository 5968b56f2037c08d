#include "methods/photons/trials/sampler_trial.h"

#include "core/shared_work.h"
#include "core/statistics.h"
#include "methods/photons/learn_light_paths.h"
#include "methods/photons/radii.h"
#include "methods/photons/trials/trial_measures.h"
#include "photonmap/importance/importance_guide.h"
#include "photonmap/importance/importance_tracing.h"
#include "sampling/brightness.h"
#include "sampling/guidance/guided_light.h"
#include "sampling/markov/chain.h"
#include "sampling/proposals/registry.h"
#include "scene/ray_counter.h"
#include "session/passes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

constexpr std::int64_t kSteps = 128;             // of a chain
constexpr std::int64_t kPathsOfBlock = 64;       // light paths
constexpr std::int64_t kPathsToLearnFrom = 2048; // as many as a render learns from at least

/// How much is tried: less where the render itself will be short.
struct Extent {
    std::int64_t importons, light_paths, brightness_samples, chains;

    explicit Extent(const Settings& s) {
        const std::int64_t work = std::min<std::int64_t>(std::max(s.light_paths, s.mutations), 500'000);
        const auto part = [&](std::int64_t most) { return std::max(most * work / 500'000, most / 8); };
        importons = part(50'000);
        light_paths = part(32'768);
        brightness_samples = part(32'768);
        chains = part(256);
    }
};

/// Variance of the parts' shares from one sample to the next, summed, over the square of the total.
double relative_variance(const std::vector<Shares>& samples) {
    std::array<RunningStats, kPartsOfTrial> parts;
    for (const Shares& s : samples)
        for (std::size_t r = 0; r < kPartsOfTrial; ++r) parts[r].add(s[r]);
    double variance = 0, total = 0;
    for (const RunningStats& p : parts) {
        variance += p.variance();
        total += p.mean();
    }
    return total > 0 ? variance / (total * total) : std::numeric_limits<double>::infinity();
}

/// Visible power of the photons of one light path, by part.
struct VisiblePower {
    const Scene& scene;
    const ImportanceGuide& global;
    const ImportanceGuide& caustic;
    StorageRule rule;
    Shares shares{};

    bool arrival(Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast& past) {
        if (!v.bsdf.traits().finite) return true;
        const StorageRule::Kinds kinds = rule(v, to_light, past);
        double visible = kinds.global ? global.visible_power(v, to_light, power).value_or(0) : 0;
        if (kinds.caustic) visible += caustic.visible_power(v, to_light, power).value_or(0);
        shares[part_of_scene(scene, v.point.p)] += visible;
        return true;
    }
};

/// `walls`: as ImportanceGuide's scene. `learned`: where light paths begin, as in a render by ipm; null: by power.
double try_emission(const SamplerContext& c, const Scene* walls, const LearnedEmission* learned,
                    const RunContext& run) {
    const bool delta = c.caustics;
    const Extent extent(c.settings);
    const auto depth = static_cast<int>(c.settings.max_depth);
    const std::uint64_t seed = seed_of_trial(c.settings);
    Importons importons = trace_importance(
        c.scene,
        {.samples = extent.importons, .at_d1 = delta, .max_scatterings = depth, .seed = seed, .weight = c.weight}, run);
    const float radius = Radii(c.scene).importance;
    const ImportanceGuide global(PhotonMap(std::move(importons.second)), radius, c.patches, walls, run);
    const ImportanceGuide caustic(PhotonMap(std::move(importons.first)), radius, c.patches, walls, run);
    const LightGuides user_paths(c.scene, c.user_paths);
    const std::uint64_t before = rays_traced();
    std::vector<Shares> samples(static_cast<std::size_t>(extent.light_paths));
    parallel_blocks(extent.light_paths, kPathsOfBlock, run, [&](std::int64_t i) {
        Rng rng(seed, StreamPurpose::emission, static_cast<std::uint64_t>(i));
        VisiblePower sink{c.scene, global, caustic, c.storage()};
        trace_light_path(c.scene, {&user_paths, learned}, depth, rng, sink);
        samples[static_cast<std::size_t>(i)] = sink.shares;
    });
    return relative_variance(samples) * static_cast<double>(rays_traced() - before) /
           static_cast<double>(extent.light_paths);
}

double try_metropolis(const SamplerContext& c, const RunContext& run) {
    const Settings& s = c.settings;
    const Extent extent(s);
    const PathSet set{.coverage = c.coverage, .weight = c.weight};
    const GuidedPaths guides(c.scene, c.user_paths, set, static_cast<int>(s.max_depth));
    const StageOneSettings first{.set = set,
                                 .max_scatterings = static_cast<int>(s.max_depth),
                                 .samples = extent.brightness_samples,
                                 .seed = seed_of_trial(s),
                                 .guides = c.user_paths.empty() ? nullptr : &guides};
    const std::uint64_t start = rays_traced();
    const StageOne one = run_stage_one(c.scene, first, run);
    const std::vector<Path> seeds = choose_seeds(c.scene, first, one, one.all_groups(), extent.chains);
    if (seeds.empty()) return std::numeric_limits<double>::infinity();
    const double b = one.brightness.mean();
    const double brightness = one.brightness.variance() / (b * b) * static_cast<double>(rays_traced() - start) /
                              static_cast<double>(extent.brightness_samples);

    const Mixture<Path> mixture = make_mixture({&c.scene, first.set, static_cast<int>(s.max_depth), &c.user_paths}, s);
    const std::uint64_t before = rays_traced();
    std::vector<Shares> samples(seeds.size(), Shares{});
    parallel_for(static_cast<std::int64_t>(seeds.size()), run, [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        Chain<Path> chain(seeds[k], mixture, Rng(first.seed, StreamPurpose::chain, static_cast<std::uint64_t>(i)));
        for (std::int64_t step = 0; step < kSteps; ++step)
            chain.step([&](const Path& path, double weight) {
                if (path.storage.kind == PhotonKind::none) return;
                const Vertex& stored = path.x[static_cast<std::size_t>(path.storage.vertex)];
                samples[k][part_of_scene(c.scene, stored.point.p)] += weight / kSteps;
            });
    });
    // A chain is one sample, of kSteps times the work of a step.
    const double chains = relative_variance(samples) * kMutationRay * static_cast<double>(rays_traced() - before) /
                          static_cast<double>(seeds.size());
    // Work is shared between the two so that their variances add up to least.
    const double root = std::sqrt(brightness) + std::sqrt(chains);
    return root * root;
}

} // namespace

SamplerTrial try_samplers(const SamplerContext& context, const RunContext& run) {
    const LearnedLightPaths learned = learn_light_paths(context, kPathsToLearnFrom, run);
    return {try_emission(context, &context.scene, learned.emission_or_null(), run), try_metropolis(context, run)};
}

bool may_be_lit(const SamplerContext& context, const RunContext& run) {
    return std::isfinite(try_emission(context, nullptr, nullptr, run));
}

} // namespace keyhole
