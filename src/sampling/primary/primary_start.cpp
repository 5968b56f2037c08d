#include "sampling/primary/primary_start.h"

#include "core/rng.h"
#include "core/shared_work.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace keyhole {
namespace {

/// Calls choose(item) `count` times in all, in the order of `items`, for each of them weight(item) / total * count
/// times on average, up or down to the next whole number. Not at all if all weights are 0.
template <class Items, class Weight, class Choose>
void resample_systematically(const Items& items, std::int64_t count, Rng& rng, Weight&& weight, Choose&& choose) {
    double total = 0;
    for (const auto& item : items) total += weight(item);
    const double shift = rng.next();
    double passed = 0;
    std::int64_t chosen = 0;
    for (const auto& item : items) {
        const double w = weight(item);
        if (!(w > 0)) continue;
        passed += w;
        for (; chosen < count && (static_cast<double>(chosen) + shift) / static_cast<double>(count) * total < passed;
             ++chosen)
            choose(item);
    }
}

constexpr std::int64_t kBlock = 1024;
/// Seeds are chosen among the first samples; brightness is measured by all.
constexpr std::int64_t kMostRemembered = std::int64_t{1} << 21;

/// Chains for each stratum in proportion to its brightness, one at least.
std::vector<std::int64_t> share_out(const std::vector<PrimaryStratum>& strata, std::int64_t chains) {
    const double total = std::accumulate(strata.begin(), strata.end(), 0.0,
                                         [](double sum, const PrimaryStratum& s) { return sum + s.brightness.mean(); });
    std::vector<std::int64_t> shares;
    for (const PrimaryStratum& s : strata)
        shares.push_back(
            std::max<std::int64_t>(1, std::llround(s.brightness.mean() / total * static_cast<double>(chains))));
    return shares;
}

} // namespace

PrimaryRandom::PrimaryRandom(std::uint64_t seed, std::int64_t index)
    : eye(seed, StreamPurpose::primary_start, 3 * static_cast<std::uint64_t>(index)),
      light(seed, StreamPurpose::primary_start, 3 * static_cast<std::uint64_t>(index) + 1),
      choice(seed, StreamPurpose::primary_start, 3 * static_cast<std::uint64_t>(index) + 2) {}

struct PrimaryStart::Block {
    std::vector<RunningStats> brightness; // by stratum
    std::vector<Find> finds;

    auto parts() { return std::tie(brightness, finds); }
};

/// Runs all samples: sample(index, random, found) appends what sample `index` finds. Results by stratum.
template <class Sample>
PrimaryStart::Block PrimaryStart::run_samples(std::size_t strata, const PrimaryStartOptions& options,
                                              const RunContext& context, Sample&& sample) {
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
    const ProgressStage progress(context, "brightness", options.samples, "samples");
    leading_blocks(options.samples, kBlock, context, run_block, [&](const Block& block) {
        for (std::size_t k = 0; k < strata; ++k) all.brightness[k].merge(block.brightness[k]);
        all.finds.insert(all.finds.end(), block.finds.begin(), block.finds.end());
    });
    return all;
}

PrimaryStart PrimaryStart::whole(std::unique_ptr<PathBuilder> builder, const PrimaryStartOptions& options,
                                 const RunContext& context) {
    PrimaryStart start(options.seed);
    Block all = run_samples(1, options, context, [&](std::int64_t i, PrimaryRandom& random, std::vector<Find>& found) {
        PathSample sample;
        builder->build(random.sources(), sample);
        if (sample.target() > 0) found.push_back({i, 0, 0, sample.target()});
    });
    if (all.finds.empty()) return start;
    start.finds_ = std::move(all.finds);
    start.strata_.push_back({std::move(builder), all.brightness[0], 1, {}, std::nullopt});
    start.techniques_.push_back(0);
    return start;
}

PrimaryStart PrimaryStart::by_length(const BuilderContext& builders, const EmitterInverse* inverses,
                                     const PrimaryStartOptions& options, const RunContext& context) {
    const Scene& scene = *builders.scene;
    const int most = builders.max_scatterings;
    const auto sample = [&](std::int64_t i, PrimaryRandom& random, std::vector<Find>& found) {
        const Vec2 image = window_point(random.eye);
        SubPathPair& pair = trace_both_subpaths(scene, image, most, random.eye, random.light, &random.choice);
        struct {
            std::int64_t i;
            std::vector<Find>& found;
            void contribution(const Connection& connection, const Rgb& value, LightClass) {
                found.push_back({i, connection.s() + connection.t() - 2, connection.s(), luminance(value)});
            }
        } sink{i, found};
        connect_subpaths(scene, pair, image, {most, PathSet::all, builders.heuristic}, sink);
    };
    PrimaryStart start(options.seed);
    Block all = run_samples(static_cast<std::size_t>(most) + 1, options, context, sample);
    std::vector<int> index(static_cast<std::size_t>(most) + 1, -1); // of the stratum of each length
    for (const Find& f : all.finds) index[static_cast<std::size_t>(f.stratum)] = 0;
    for (int k = 0; k <= most; ++k) {
        const auto at = static_cast<std::size_t>(k);
        if (index[at] < 0) continue;
        index[at] = static_cast<int>(start.strata_.size());
        start.strata_.push_back({make_multiplexed_builder(builders, k),
                                 all.brightness[at],
                                 static_cast<double>(technique_count(k)),
                                 {},
                                 std::nullopt});
        if (inverses != nullptr) start.strata_.back().change.emplace(builders, *inverses, k);
        start.techniques_.push_back(technique_count(k));
    }
    start.finds_ = std::move(all.finds);
    for (Find& f : start.finds_) f.stratum = index[static_cast<std::size_t>(f.stratum)];
    return start;
}

const std::vector<PrimaryStratum>& PrimaryStart::choose_seeds(std::int64_t chains, std::uint64_t group) {
    const auto shares = share_out(strata_, chains);
    Rng rng(seed_, StreamPurpose::seed_choice, group);
    for (std::size_t k = 0; k < strata_.size(); ++k) {
        strata_[k].seeds.clear();
        resample_systematically(
            finds_, shares[k], rng, [&](const Find& f) { return f.stratum == static_cast<int>(k) ? f.luminance : 0.0; },
            [&](const Find& f) {
                const int techniques = techniques_[k];
                strata_[k].seeds.push_back({f.sample, techniques > 0 ? (f.s + rng.next()) / techniques : -1.0});
            });
    }
    return strata_;
}

} // namespace keyhole
