#include "sampling/primary/primary_start.h"

#include "core/leading_blocks.h"
#include "sampling/resampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keyhole {
namespace {

constexpr std::int64_t kBlock = 1024;
/// Seeds are chosen among the first samples; brightness is measured by all.
constexpr std::int64_t kMostRemembered = std::int64_t{1} << 21;

/// Something that a sample found.
struct Find {
    std::int64_t sample;
    int stratum;
    int s; ///< technique; 0 where there is nothing to choose
    double luminance;
};

struct Block {
    std::vector<RunningStats> brightness; ///< by stratum
    std::vector<Find> finds;
};

/// Runs all samples: sample(index, random, found) appends what sample `index` finds. Results by stratum.
template <class Sample>
Block run_samples(std::size_t strata, const PrimaryStartOptions& options, const RunContext& context, Sample&& sample) {
    const auto run_block = [&](Range range) {
        Block block;
        block.brightness.resize(strata);
        std::vector<Find> found;
        std::vector<double> sums(strata);
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            PrimaryRandom random(options.seed, i);
            found.clear();
            std::fill(sums.begin(), sums.end(), 0.0);
            sample(i, random, found);
            for (const Find& f : found) sums[static_cast<std::size_t>(f.stratum)] += f.luminance;
            for (std::size_t k = 0; k < strata; ++k) block.brightness[k].add(sums[k]);
            if (i < kMostRemembered) block.finds.insert(block.finds.end(), found.begin(), found.end());
        }
        return block;
    };
    Block all;
    all.brightness.resize(strata);
    context.begin("brightness", static_cast<std::uint64_t>(options.samples), "samples");
    leading_blocks(options.samples, kBlock, context, run_block, [&](const Block& block) {
        for (std::size_t k = 0; k < strata; ++k) all.brightness[k].merge(block.brightness[k]);
        all.finds.insert(all.finds.end(), block.finds.begin(), block.finds.end());
    });
    context.end();
    return all;
}

/// `count` seeds among the finds of a stratum, with probability proportional to luminance: systematic resampling.
template <class MakeSeed>
std::vector<PrimarySeed> resample(const std::vector<Find>& finds, int stratum, std::int64_t count, Rng& rng,
                                  MakeSeed&& make_seed) {
    std::vector<PrimarySeed> seeds;
    resample_systematically(
        finds, count, rng, [&](const Find& f) { return f.stratum == stratum ? f.luminance : 0.0; },
        [&](const Find& f) { seeds.push_back(make_seed(f)); });
    return seeds;
}

/// Chains for each stratum in proportion to its brightness, one at least where there is any.
std::vector<std::int64_t> share_out(const std::vector<RunningStats>& brightness, std::int64_t chains) {
    const double total = std::accumulate(brightness.begin(), brightness.end(), 0.0,
                                         [](double sum, const RunningStats& b) { return sum + b.mean(); });
    std::vector<std::int64_t> shares;
    for (const RunningStats& b : brightness) {
        const double share = total > 0 ? b.mean() / total * static_cast<double>(chains) : 0.0;
        shares.push_back(b.mean() > 0 ? std::max<std::int64_t>(1, std::llround(share)) : 0);
    }
    return shares;
}

} // namespace

PrimaryRandom::PrimaryRandom(std::uint64_t seed, std::int64_t index)
    : eye(seed, StreamPurpose::primary_start, 3 * static_cast<std::uint64_t>(index)),
      light(seed, StreamPurpose::primary_start, 3 * static_cast<std::uint64_t>(index) + 1),
      choice(seed, StreamPurpose::primary_start, 3 * static_cast<std::uint64_t>(index) + 2) {}

PrimaryStratum start_whole(std::unique_ptr<PathBuilder> builder, const PrimaryStartOptions& options,
                           const RunContext& context) {
    const Block all =
        run_samples(1, options, context, [&](std::int64_t i, PrimaryRandom& random, std::vector<Find>& found) {
            PathSample sample;
            builder->build(random.sources(), sample);
            if (sample.target() > 0) found.push_back({i, 0, 0, sample.target()});
        });
    Rng rng(options.seed, StreamPurpose::seed_choice, 0);
    PrimaryStratum stratum{std::move(builder), all.brightness[0], 1, {}, std::nullopt};
    stratum.seeds = resample(all.finds, 0, options.chains, rng, [](const Find& f) {
        return PrimarySeed{f.sample, -1};
    });
    return stratum;
}

std::vector<PrimaryStratum> start_by_length(const BuilderContext& builders, const EmitterInverse* inverses,
                                            const PrimaryStartOptions& options, const RunContext& context) {
    const Scene& scene = *builders.scene;
    const int most = builders.max_scatterings;
    const auto sample = [&](std::int64_t i, PrimaryRandom& random, std::vector<Find>& found) {
        const Vec2 image = window_point(random.eye);
        auto& [eye, light] = SubPathPair::scratch();
        trace_eye_subpath(scene, image, most_eye_vertices(most), random.eye, &random.choice, eye);
        trace_light_subpath(scene, most_light_vertices(most), random.light, &random.choice, light);
        struct {
            std::int64_t i;
            std::vector<Find>& found;
            void contribution(const Joint& joint, const Rgb& value, LightClass) {
                found.push_back({i, joint.s() + joint.t() - 2, joint.s(), luminance(value)});
            }
        } sink{i, found};
        connect_subpaths(scene, light, eye, image, most, PathSet::all, builders.heuristic, sink);
    };
    const Block all = run_samples(static_cast<std::size_t>(most) + 1, options, context, sample);
    const auto chains = share_out(all.brightness, options.chains);
    Rng rng(options.seed, StreamPurpose::seed_choice, 0);
    std::vector<PrimaryStratum> strata;
    for (int k = 0; k <= most; ++k) {
        const auto at = static_cast<std::size_t>(k);
        auto seeds = resample(all.finds, k, chains[at], rng, [&](const Find& f) {
            return PrimarySeed{f.sample, (f.s + rng.next()) / technique_count(k)};
        });
        if (seeds.empty()) continue;
        strata.push_back({make_multiplexed_builder(builders, k), all.brightness[at],
                          static_cast<double>(technique_count(k)), std::move(seeds), std::nullopt});
        if (inverses != nullptr) strata.back().change.emplace(builders, *inverses, k);
    }
    return strata;
}

} // namespace keyhole
