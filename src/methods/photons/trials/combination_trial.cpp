#include "methods/photons/trials/trials.h"

#include "core/parallel.h"
#include "methods/method.h"
#include "methods/photons/chain_importance.h"
#include "methods/photons/learn_light_paths.h"
#include "methods/photons/radii.h"
#include "photonmap/importance/importance_tracing.h"
#include "photonmap/photon_weighing.h"
#include "sampling/guidance/guided_light.h"
#include "sampling/markov/chain.h"
#include "sampling/proposals/registry.h"
#include "scene/ray_counter.h"
#include "session/passes.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <ranges>
#include <span>
#include <utility>

namespace keyhole {
namespace {

constexpr int kCellsOfTrial = 4; ///< along each axis
constexpr std::size_t kPartsOfTrial = std::size_t{kCellsOfTrial} * kCellsOfTrial * kCellsOfTrial;
using Shares = std::array<double, kPartsOfTrial>;

/// The part that a point lies in: equal cells of the scene's bounding box.
std::size_t part_of_scene(const Scene& scene, const Vec3& p) {
    std::size_t index = 0;
    for (int k = 0; k < 3; ++k) {
        const float extent = scene.upper()[k] - scene.lower()[k];
        const float x = extent > 0 ? (p[k] - scene.lower()[k]) / extent : 0.0f;
        const int cell = std::clamp(static_cast<int>(x * kCellsOfTrial), 0, kCellsOfTrial - 1);
        index = index * kCellsOfTrial + static_cast<std::size_t>(cell);
    }
    return index;
}

/// What a mutation does besides tracing rays, measuring paths in the main, costs as much as several rays of light
/// tracing.
constexpr double kMutationRay = 3;

constexpr std::int64_t kImportons = 10'000, kSamples = 4096, kPaths = 8192, kLearning = 2048, kChains = 64;
constexpr std::int64_t kStepsOfChain = 64;      // of a chain
constexpr std::int64_t kPathsOfTrialBlock = 64; // light paths
constexpr std::array kShares{0.0, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 1.0};
constexpr std::array kCorrelations{1.0, 4.0, 16.0, 64.0, 256.0};
/// Chains are too short to show what they never reach: their variance counts so many times.
constexpr double kDoubt = 2;
/// Chains have to cost less than this of what light tracing does, and a larger share of them less than that of what a
/// smaller one does.
constexpr double kWorthIt = 0.5, kWorthMore = 0.95;
/// Of all light, what light paths have to find.
constexpr double kMostOf = 0.7;

/// A photon of the trial.
struct Find {
    std::size_t part; ///< of the scene
    double visible;   ///< V; 0 where importance is unknown
    double amount;    ///< of visible power that it would bring if there were no other technique: V for light tracing
};
/// Photons of one light path, or of one chain.
using Finds = std::vector<Find>;

/// What samples of either technique found.
struct Trial {
    std::vector<Finds> paths, chains;
    double brightness = 0;
    double brightness_variance = 0; ///< of a sample, over the square
    double rays_of_path = 0, rays_of_step = 0, rays_of_sample = 0;

    /// Whether light paths found about as much light as there is: then their own variance tells all. What chains say of
    /// it would be that of a few bright places where they stayed.
    bool complete() const {
        double found = 0;
        for (const Finds& finds : paths)
            for (const Find& f : finds) found += f.amount;
        return found > kMostOf * brightness * static_cast<double>(paths.size());
    }
};

struct Sink {
    const Scene& scene;
    const PhotonWeighing& weighing;
    StorageRule rule;
    Finds& finds;

    bool arrival(Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast& past) {
        if (!v.bsdf.traits().finite) return true;
        const StorageRule::Kinds kinds = rule(v, to_light, past);
        if (kinds.global) add(PhotonKind::global, v, to_light, power);
        if (kinds.caustic) add(PhotonKind::caustic, v, to_light, power);
        return true;
    }
    void add(PhotonKind kind, const Vertex& v, const Vec3& to_light, const Rgb& power) const {
        const PhotonWeighing::Weight visible = weighing(kind, v, to_light, power);
        if (visible.known) finds.push_back({part_of_scene(scene, v.point.p), visible.value, visible.value});
    }
};

void try_light_paths(const SamplerContext& c, const EmissionGuide& guide, const LightPathSampling& sampling,
                     Trial& trial, const RunContext& run) {
    const std::uint64_t before = rays_traced();
    const PhotonWeighing weighing{guide};
    trial.paths.resize(static_cast<std::size_t>(kPaths));
    parallel_blocks(kPaths, kPathsOfTrialBlock, run, [&](std::int64_t i) {
        Rng rng(seed_of_trial(c.settings), StreamPurpose::emission, static_cast<std::uint64_t>(i));
        Sink sink{c.scene, weighing, c.storage(), trial.paths[static_cast<std::size_t>(i)]};
        trace_light_path(c.scene, sampling, sink.rule.max_scatterings, rng, sink);
    });
    trial.rays_of_path = static_cast<double>(rays_traced() - before) / kPaths;
}

void try_chains(const SamplerContext& c, const EmissionGuide& guide, const LightPathSampling& sampling, Trial& trial,
                const RunContext& run) {
    const auto depth = static_cast<int>(c.settings.max_depth);
    const GuidedPaths guides(c.scene, c.user_paths, c.path_set(), depth);
    StageOneSettings first = stage_one_settings(c, seed_of_trial(c.settings), guides);
    first.samples = kSamples;
    first.error = 0;
    std::uint64_t before = rays_traced();
    const StageOne one = run_stage_one(c.scene, first, run);
    trial.rays_of_sample = static_cast<double>(rays_traced() - before) / static_cast<double>(one.samples);
    trial.brightness = one.brightness.mean();
    if (!(trial.brightness > 0)) return;
    trial.brightness_variance = one.brightness.variance() / (trial.brightness * trial.brightness);
    const std::vector<Path> seeds = choose_seeds(c.scene, first, one, one.all_groups(), kChains);
    const Mixture<Path> mixture = make_mixture({&c.scene, first.set, depth, &c.user_paths}, c.settings);
    const TechniqueWeights weights(guide, sampling, 0);
    before = rays_traced();
    trial.chains.resize(seeds.size());
    parallel_for(static_cast<std::int64_t>(seeds.size()), run, [&](std::int64_t i) {
        const auto k = static_cast<std::size_t>(i);
        Chain<Path> chain(seeds[k], mixture, Rng(first.seed, StreamPurpose::chain, static_cast<std::uint64_t>(i)));
        for (std::int64_t step = 0; step < kStepsOfChain; ++step)
            chain.step([&](const Path& path, double weight) {
                const StoragePoint at = path.storage;
                if (at.kind == PhotonKind::none) return;
                const auto visible = weights.visible(c.scene, at.kind, path, at.vertex);
                const Vec3& p = path.x[at.vertex].point.p;
                trial.chains[k].push_back({part_of_scene(c.scene, p), visible.known ? visible.value : 0,
                                           trial.brightness * weight / kStepsOfChain});
            });
    });
    trial.rays_of_step =
        kMutationRay * static_cast<double>(rays_traced() - before) / static_cast<double>(seeds.size() * kStepsOfChain);
}

/// Mean and variance by part of what samples found, each find times weigh(find).
struct Moments {
    Shares mean{}, variance{};

    template <class Weigh> Moments(const std::vector<Finds>& samples, const Weigh& weigh) {
        const auto n = static_cast<double>(samples.size());
        Shares sum{};
        for (const Finds& finds : samples) {
            for (const Find& f : finds) sum[f.part] += f.amount * weigh(f);
            for (const Find& f : finds) {
                const double x = std::exchange(sum[f.part], 0);
                mean[f.part] += x / n;
                variance[f.part] += x * x / (n - 1);
            }
        }
        for (std::size_t r = 0; r < kPartsOfTrial; ++r) variance[r] -= mean[r] * mean[r] * n / (n - 1);
    }
};

/// Numbers of samples that a pass makes with a share of chains, and what both techniques make of them.
struct Combination {
    double paths, steps;
    double samples; ///< of stage one, as effort sets them for so many steps
    double odds;
    Moments light, chains;

    Combination(const Trial& t, const Settings& s, const WorkShares& shares)
        : paths((1 - shares.chains) * static_cast<double>(s.light_paths)),
          steps(shares.chains * static_cast<double>(s.mutations)),
          samples(steps * methods::cps.brightness_samples_of_effort / methods::cps.mutations_of_effort),
          odds(steps / (shares.correlation * paths * t.brightness)),
          light(t.paths, [&](const Find& f) { return 1 - of_chains(f); }),
          chains(t.chains, [&](const Find& f) { return of_chains(f); }) {
        if (t.complete()) return;
        // The variance of light that chains find and light paths would bring seldom, with great power, is the mean over
        // chains of V (1 - w)^2, since p V^2 = C V.
        const Moments rare(t.chains, [&](const Find& f) {
            const double w = 1 - of_chains(f);
            return w > 0 ? f.visible * w * w : 0.0;
        });
        for (std::size_t r = 0; r < kPartsOfTrial; ++r)
            light.variance[r] = std::max(light.variance[r], rare.mean[r] - light.mean[r] * light.mean[r]);
    }

    double of_chains(const Find& f) const { return paths > 0 ? 1 / (1 + 1 / (odds * f.visible)) : 1.0; }

    /// Relative variance of parts, each counted by its light of `mean`.
    double variance(const Trial& t, const Shares& mean) const {
        double sum = 0, all = 0, of_all = 0;
        for (std::size_t r = 0; r < kPartsOfTrial; ++r) {
            all += mean[r];
            of_all += chains.mean[r];
            if (!(mean[r] > 0)) continue;
            if (paths > 0) sum += light.variance[r] / (paths * mean[r]);
            if (steps > 0) sum += kDoubt * chains.variance[r] * kStepsOfChain / (steps * mean[r]);
        }
        const double share = of_all / all;
        return sum / all + (samples > 0 ? share * share * t.brightness_variance / samples : 0.0);
    }
    double rays(const Trial& t) const {
        return paths * t.rays_of_path + steps * t.rays_of_step + samples * t.rays_of_sample;
    }
};

} // namespace

WorkShares try_shares(const SamplerContext& c, const RunContext& run) {
    const ChainImportance importance(c, seed_of_trial(c.settings), kImportons, run);
    const float radius = Radii(c.scene).importance;
    const ImportanceGuide global(importance.at_d2.map(), radius, c.patches, &c.scene, run);
    const ImportanceGuide caustic(importance.at_d1.map(), radius, c.patches, &c.scene, run);
    const EmissionGuide guide{&global, c.caustics ? &caustic : nullptr};
    const LightGuides user_paths(c.scene, c.user_paths);
    const LearnedLightPaths learned = learn_light_paths(c, kLearning, run);
    const LightPathSampling sampling{&user_paths, learned.emission_or_null()};
    Trial trial;
    try_light_paths(c, guide, sampling, trial, run);
    try_chains(c, guide, sampling, trial, run);
    if (trial.chains.empty()) return {0, 1};
    const Combination even(trial, c.settings, {0.5, 1});
    Shares mean;
    std::ranges::transform(even.light.mean, even.chains.mean, mean.begin(), std::plus());
    // The smallest share of those that are about as good: what chains never reach doesn't show.
    WorkShares best{0, 1};
    double least = std::numeric_limits<double>::infinity();
    const std::optional<double>& given = c.settings.chain_share.value;
    for (const double share : given ? std::span(&*given, 1) : std::span<const double>(kShares))
        for (const double correlation : kCorrelations) {
            const Combination combination(trial, c.settings, {share, correlation});
            const double error = combination.variance(trial, mean) * combination.rays(trial);
            const double better = share == best.chains ? 1.0 : best.chains == 0 ? kWorthIt : kWorthMore;
            if (!(error < better * least)) continue;
            least = error;
            best = {share, correlation};
        }
    return best;
}

} // namespace keyhole
