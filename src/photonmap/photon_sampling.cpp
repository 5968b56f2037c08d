#include "photonmap/photon_sampling.h"

#include "core/shared_work.h"
#include "photonmap/power.h"
#include "sampling/markov/chain_rounds.h"

#include <algorithm>
#include <memory>
#include <span>

namespace keyhole {

ChainSeeds choose_chain_seeds(const Scene& scene, const StageOneSettings& settings, const StageOne& stage,
                              std::int64_t chains) {
    const Range all = stage.all_groups();
    const Range for_pilots{0, all.end / kPilotEvery}, for_main{for_pilots.end, all.end};
    const std::int64_t pilots = chains / kPilotEvery;
    return {choose_seeds(scene, settings, stage, for_pilots, pilots),
            choose_seeds(scene, settings, stage, for_main, chains - pilots), stage.brightness_of(for_main)};
}

namespace {

std::int64_t chains_of(const ChainSeeds& seeds) {
    return static_cast<std::int64_t>(seeds.pilots.size() + seeds.main_photons.size());
}

std::int64_t steps_of_chain(const ChainSeeds& seeds, const PhotonSamplingOptions& options) {
    return std::max<std::int64_t>(1, options.mutations / chains_of(seeds));
}

} // namespace

PhotonChains run_photon_chains(const ChainSeeds& seeds, const Mixture<Path>& mixture, const DepositOptions& deposit,
                               const PhotonSamplingOptions& options, MapStores& stores, const RunContext& context) {
    PhotonChains out;
    if (seeds.main_photons.empty()) return out;
    std::vector<Path> all = seeds.pilots;
    all.insert(all.end(), seeds.main_photons.begin(), seeds.main_photons.end());
    const auto chains = static_cast<std::int64_t>(all.size());
    const Range own = own_part(chains, context);
    auto set = std::make_unique<ChainSet>(
        std::span(all).subspan(static_cast<std::size_t>(own.begin), static_cast<std::size_t>(own.size())), mixture,
        options.seed, options.control, own.begin);
    const auto role_of = [&](std::size_t c) {
        return c < seeds.pilots.size() ? PhotonRole::pilot : PhotonRole::main_photon;
    };
    std::vector<MapBuffers> buffers(all.size()); // of all chains
    std::vector<PathDepositor> depositors;       // of the own ones
    depositors.reserve(static_cast<std::size_t>(own.size()));
    for (std::int64_t c = own.begin; c < own.end; ++c) {
        const auto at = static_cast<std::size_t>(c);
        DepositOptions one = deposit;
        one.role = role_of(at);
        depositors.emplace_back(one, Rng(options.seed, StreamPurpose::chain, 2 * at + 1), buffers[at]);
    }

    const std::int64_t per_chain = steps_of_chain(seeds, options);
    const auto photons = static_cast<std::int64_t>(options.global_photons + options.caustic_photons);
    const std::int64_t round = round_length(photons, chains);
    const ProgressStage progress(context, "photons", per_chain * own.size(), "mutations");
    ChainRounds::of_length(per_chain, round).run(context, [&](std::int64_t n) {
        for (PathDepositor& depositor : depositors) depositor.set_thresholds(stores.thresholds(depositor.role()));
        set->advance(n, context, [&](std::int64_t c, const Path& path, double weight) {
            depositors[static_cast<std::size_t>(c)].deposit(path, weight);
        });
        stores.absorb(buffers, role_of, context);
    });
    for (PathDepositor& depositor : depositors) depositor.flush();
    stores.absorb(buffers, role_of, context);

    out.chains = set->summary();
    const double steps = static_cast<double>(set->steps()) * static_cast<double>(seeds.main_photons.size());
    std::vector<PathDepositor::Tally> tallies(all.size());
    for (std::int64_t c = own.begin; c < own.end; ++c)
        tallies[static_cast<std::size_t>(c)] = depositors[static_cast<std::size_t>(c - own.begin)].tally();
    exchange_parts(tallies, context);
    for (std::size_t c = seeds.pilots.size(); c < tallies.size(); ++c) out.tally.merge(tallies[c]);
    out.caustic_scale = path_chain_scale(seeds.brightness, steps);
    out.global_scale = literal_scale(out.caustic_scale, out.tally.visible_weight, out.tally.visible);
    return out;
}

SampledPhotons sample_photons(const ChainSeeds& seeds, const Mixture<Path>& mixture, const DepositOptions& deposit,
                              const PhotonSamplingOptions& options, const RunContext& context) {
    SampledPhotons out;
    if (seeds.main_photons.empty()) return out;
    // Stores are shared: chains differ in what they find, and thinning must treat all photons alike. The threshold that
    // the run is expected to end with is there from the start.
    const auto mutations = static_cast<double>(steps_of_chain(seeds, options) * chains_of(seeds));
    const auto photons = static_cast<double>(options.global_photons + options.caustic_photons);
    const double threshold = std::max(0.2, 0.8 * mutations / std::max(1.0, photons));
    MapStores stores({options.global_photons, options.caustic_photons}, unit_of_power(*deposit.scene),
                     {threshold, threshold}, options.seed);
    static_cast<PhotonChains&>(out) = run_photon_chains(seeds, mixture, deposit, options, stores, context);
    out.bytes = stores.bytes_held();
    static_cast<Photons&>(out) = stores.release(out.global_scale, out.caustic_scale);
    return out;
}

} // namespace keyhole
