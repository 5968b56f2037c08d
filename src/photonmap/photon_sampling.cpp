#include "photonmap/photon_sampling.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace keyhole {
namespace {

/// Steps of each chain between two visits to the stores, so that the chains' buffers stay small beside these.
std::int64_t round_length(std::int64_t photons, std::int64_t chains) {
    return std::clamp<std::int64_t>(photons / (32 * chains), 2, 256);
}

} // namespace

SampledPhotons sample_photons(const std::vector<Path>& seeds, const Mixture<Path>& mixture,
                              const DepositOptions& deposit, const PhotonSamplingOptions& options,
                              const RunContext& context) {
    const auto chains = static_cast<std::int64_t>(seeds.size());
    SampledPhotons out;
    if (chains == 0) return out;
    auto set = std::make_unique<ChainSet>(seeds, mixture, options.seed, options.control);
    std::vector<PathDepositor> depositors;
    depositors.reserve(seeds.size());
    for (std::uint64_t c = 0; c < seeds.size(); ++c)
        depositors.emplace_back(deposit, Rng(options.seed, StreamPurpose::chain, 2 * c + 1));

    // Stores are shared: chains differ in what they find, and thinning must treat all photons alike. The threshold that
    // the run is expected to end with is there from the start.
    const std::int64_t per_chain = std::max<std::int64_t>(1, options.mutations / chains);
    const auto mutations = static_cast<double>(per_chain * chains);
    const auto photons = static_cast<std::int64_t>(options.global_photons + options.caustic_photons);
    const double threshold = std::max(0.2, 0.8 * mutations / static_cast<double>(std::max<std::int64_t>(1, photons)));
    PhotonStore global(options.global_photons, threshold, Rng(options.seed, StreamPurpose::thinning, 0));
    PhotonStore caustic(options.caustic_photons, threshold, Rng(options.seed, StreamPurpose::thinning, 1));
    const auto collect = [&] {
        for (PathDepositor& depositor : depositors) {
            global.absorb(depositor.global());
            caustic.absorb(depositor.caustic());
        }
    };

    // In rounds, so that a stop finds all chains equally long.
    const std::int64_t round = round_length(photons, chains);
    context.begin("photons", static_cast<std::uint64_t>(per_chain * chains), "mutations");
    while (set->steps() < per_chain && !(context.stopped() && set->steps() > 0)) {
        for (PathDepositor& depositor : depositors) depositor.set_thresholds(global.threshold(), caustic.threshold());
        set->advance(std::min(round, per_chain - set->steps()), context,
                     [&](std::int64_t c, const Path& path, double weight) {
                         depositors[static_cast<std::size_t>(c)].deposit(path, weight);
                     });
        collect();
    }
    context.end();
    for (PathDepositor& depositor : depositors) depositor.flush();
    collect();

    out.chains = set->summary();
    set.reset(); // its memory is needed below
    const double scale = options.brightness / static_cast<double>(out.chains.steps);
    for (const PathDepositor& depositor : depositors) out.tally.merge(depositor.tally());
    // The literal rule leaves a scale open: that which makes the photons as visible as the paths were.
    const double seen = out.tally.visible;
    out.bytes = global.bytes() + caustic.bytes();
    out.global = global.release(seen > 0 ? scale * out.tally.visible_weight / seen : scale);
    out.caustic = caustic.release(scale);
    return out;
}

} // namespace keyhole
