// Where chains of light sub-paths begin.
#include "core/shared_work.h"
#include "photonmap/light_chains/light_arrivals.h"
#include "photonmap/light_chains/light_chains.h"
#include "sampling/paths/resampling.h"
#include "sampling/primary/primary_start.h"

#include <algorithm>

namespace keyhole {
namespace {

constexpr std::int64_t kSamplesOfBlock = 1024;
constexpr std::int64_t kMost = std::int64_t{1} << 20;

/// What a sample found. The share of what is unknown in the target follows from all of them.
struct Find {
    std::int64_t sample;
    double known, unknown;
};

struct StartBlock {
    std::vector<Find> finds; ///< one for each sample
    PhotonWeights weights;

    auto parts() { return std::tie(finds, weights); }
};

StartBlock sample_block(const LightBuilder& builder, std::uint64_t seed, Range samples) {
    StartBlock block;
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

bool is_pilots(const Find& find) { return role_of_sample(find.sample) == PhotonRole::pilot; }

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
        samples, kSamplesOfBlock, context, [&](Range range) { return sample_block(builder, options.seed, range); },
        [&](const StartBlock& block) {
            start.weights += block.weights;
            finds.insert(finds.end(), block.finds.begin(), block.finds.end());
        });
    context.end();
    start.samples = static_cast<std::int64_t>(finds.size());
    const double unknown_scale = start.weights.unknown_scale();
    const auto target = [&](const Find& f) { return f.known + unknown_scale * f.unknown; };
    for (const Find& f : finds) (is_pilots(f) ? start.pilots : start.main_photons).target.add(target(f));

    Rng rng(options.seed, StreamPurpose::seed_choice, 0);
    const std::int64_t pilots = std::max<std::int64_t>(1, options.chains / kPilotEvery);
    const auto choose = [&](LightChainStart::Part& part, bool of_pilots, std::int64_t count) {
        resample_systematically(
            finds, count, rng, [&](const Find& f) { return is_pilots(f) == of_pilots ? target(f) : 0.0; },
            [&](const Find& f) { part.seeds.push_back(f.sample); });
    };
    choose(start.pilots, true, pilots);
    choose(start.main_photons, false, std::max<std::int64_t>(1, options.chains - pilots));
    return start;
}

} // namespace keyhole
