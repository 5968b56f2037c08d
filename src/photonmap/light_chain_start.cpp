// Where chains of light sub-paths begin.
#include "core/leading_blocks.h"
#include "photonmap/light_arrivals.h"
#include "photonmap/light_chains.h"
#include "sampling/primary/primary_start.h"
#include "sampling/resampling.h"

#include <algorithm>

namespace keyhole {
namespace {

constexpr std::int64_t kBlock = 1024;
constexpr std::int64_t kMost = std::int64_t{1} << 20;

/// What a sample found. The share of what is unknown in the target follows from all of them.
struct Find {
    std::int64_t sample;
    double known, unknown;
};

struct Block {
    std::vector<Find> finds; ///< one for each sample
    PhotonWeights weights;

    auto parts() { return std::tie(finds, weights); }
};

Block sample_block(const LightBuilder& builder, std::uint64_t seed, Range samples) {
    Block block;
    LightArrivals sample;
    for (std::int64_t i = samples.begin; i < samples.end; ++i) {
        PrimaryRandom random(seed, i);
        sample.clear();
        builder.build({random.light, random.choice}, sample);
        Find find{i, 0, 0};
        for (const Arrival& a : sample.arrivals()) {
            (a.known ? find.known : find.unknown) += a.weight;
            block.weights.add(a.kind, {a.weight, a.known}, a.weight);
        }
        block.finds.push_back(find);
    }
    return block;
}

bool is_scouts(const Find& find) { return role_of_sample(find.sample) == PhotonRole::scout; }

} // namespace

LightChainStart start_light_chains(const Scene& scene, const EmissionGuide& guide, const LightChainOptions& options,
                                   const RunContext& context) {
    LightChainStart start;
    if (scene.emitter_distribution().empty()) return start;
    const std::int64_t samples = std::min(options.samples, kMost);
    const LightBuilder builder(scene, {guide, 1}, options.rule);
    context.begin("brightness", static_cast<std::uint64_t>(samples), "samples");
    std::vector<Find> finds;
    leading_blocks(
        samples, kBlock, context, [&](Range range) { return sample_block(builder, options.seed, range); },
        [&](const Block& block) {
            start.weights += block.weights;
            finds.insert(finds.end(), block.finds.begin(), block.finds.end());
        });
    context.end();
    start.samples = static_cast<std::int64_t>(finds.size());
    const double unknown_scale = start.weights.unknown_scale();
    const auto target = [&](const Find& f) { return f.known + unknown_scale * f.unknown; };
    for (const Find& f : finds) (is_scouts(f) ? start.scouts : start.carriers).target.add(target(f));

    Rng rng(options.seed, StreamPurpose::seed_choice, 0);
    const std::int64_t scouts = std::max<std::int64_t>(1, options.chains / kScoutEvery);
    const auto choose = [&](LightChainStart::Part& part, bool of_scouts, std::int64_t count) {
        resample_systematically(
            finds, count, rng, [&](const Find& f) { return is_scouts(f) == of_scouts ? target(f) : 0.0; },
            [&](const Find& f) { part.seeds.push_back(f.sample); });
    };
    choose(start.scouts, true, scouts);
    choose(start.carriers, false, std::max<std::int64_t>(1, options.chains - scouts));
    return start;
}

} // namespace keyhole
