#include "photonmap/photon_sampling.h"

#include "core/shared_work.h"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

namespace keyhole {
ChainSeeds choose_chain_seeds(const Scene& scene, const StageOneSettings& settings, const StageOne& stage,
                              std::int64_t chains) {
    const Range all = stage.all_groups();
    const Range for_scouts{0, all.end / kScoutEvery}, for_carriers{for_scouts.end, all.end};
    const std::int64_t scouts = chains / kScoutEvery;
    return {choose_seeds(scene, settings, stage, for_scouts, scouts),
            choose_seeds(scene, settings, stage, for_carriers, chains - scouts), stage.brightness_of(for_carriers)};
}

SampledPhotons sample_photons(const ChainSeeds& seeds, const Mixture<Path>& mixture, const DepositOptions& deposit,
                              const PhotonSamplingOptions& options, const RunContext& context) {
    SampledPhotons out;
    if (seeds.carriers.empty()) return out;
    std::vector<Path> all = seeds.scouts;
    all.insert(all.end(), seeds.carriers.begin(), seeds.carriers.end());
    const auto chains = static_cast<std::int64_t>(all.size());
    const Range own = own_part(chains, context);
    auto set = std::make_unique<ChainSet>(
        std::span(all).subspan(static_cast<std::size_t>(own.begin), static_cast<std::size_t>(own.size())), mixture,
        options.seed, options.control, own.begin);
    const auto role_of = [&](std::int64_t c) {
        return c < static_cast<std::int64_t>(seeds.scouts.size()) ? PhotonRole::scout : PhotonRole::carrier;
    };
    std::vector<PathDepositor> depositors; // of the own chains
    depositors.reserve(static_cast<std::size_t>(own.size()));
    for (std::int64_t c = own.begin; c < own.end; ++c) {
        DepositOptions one = deposit;
        one.role = role_of(c);
        depositors.emplace_back(one, Rng(options.seed, StreamPurpose::chain, 2 * static_cast<std::uint64_t>(c) + 1));
    }

    // Stores are shared: chains differ in what they find, and thinning must treat all photons alike. The threshold that
    // the run is expected to end with is there from the start.
    const std::int64_t per_chain = std::max<std::int64_t>(1, options.mutations / chains);
    const auto mutations = static_cast<double>(per_chain * chains);
    const auto photons = static_cast<std::int64_t>(options.global_photons + options.caustic_photons);
    const double threshold = std::max(0.2, 0.8 * mutations / static_cast<double>(std::max<std::int64_t>(1, photons)));
    MapStores stores(options.global_photons, options.caustic_photons, {threshold, threshold}, options.seed);
    std::vector<MapBuffers> buffers(all.size()); // of all chains
    const auto collect = [&] {
        for (std::int64_t c = own.begin; c < own.end; ++c)
            std::swap(buffers[static_cast<std::size_t>(c)],
                      depositors[static_cast<std::size_t>(c - own.begin)].buffers());
        exchange_parts(buffers, context);
        for (std::int64_t c = 0; c < chains; ++c) stores.absorb(role_of(c), buffers[static_cast<std::size_t>(c)]);
        for (std::int64_t c = own.begin; c < own.end; ++c) // empty, with the memory that they have
            std::swap(buffers[static_cast<std::size_t>(c)],
                      depositors[static_cast<std::size_t>(c - own.begin)].buffers());
    };

    // In rounds, so that a stop finds all chains equally long.
    const std::int64_t round = round_length(photons, chains);
    context.begin("photons", static_cast<std::uint64_t>(per_chain * own.size()), "mutations");
    while (set->steps() < per_chain && !(context.stopped() && set->steps() > 0)) {
        for (PathDepositor& depositor : depositors) depositor.set_thresholds(stores.thresholds(depositor.role()));
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
    const double steps = static_cast<double>(set->steps()) * static_cast<double>(seeds.carriers.size());
    set.reset(); // its memory is needed below
    std::vector<PathDepositor::Tally> tallies(all.size());
    for (std::int64_t c = own.begin; c < own.end; ++c)
        tallies[static_cast<std::size_t>(c)] = depositors[static_cast<std::size_t>(c - own.begin)].tally();
    exchange_parts(tallies, context);
    for (std::size_t c = seeds.scouts.size(); c < tallies.size(); ++c) out.tally.merge(tallies[c]);
    const double scale = seeds.brightness / steps;
    // The literal rule leaves a scale open: that which makes the photons as visible as the paths were.
    const double seen = out.tally.visible;
    out.bytes = stores.bytes();
    static_cast<Photons&>(out) = stores.release(seen > 0 ? scale * out.tally.visible_weight / seen : scale, scale);
    return out;
}

} // namespace keyhole
