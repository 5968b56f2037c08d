#include "photonmap/photon_sampling.h"

#include "core/parallel.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace keyhole {
namespace {

/// A chain with what it is about to store.
struct ChainRun {
    Chain<Path> chain;
    PathDepositor depositor;

    ChainRun(const Path& seed, const Mixture<Path>& mixture, const DepositImportance& importance,
             std::uint64_t seed_number, std::uint64_t index)
        : chain(seed, mixture, Rng(seed_number, StreamPurpose::chain, 2 * index)),
          depositor(importance, Rng(seed_number, StreamPurpose::chain, 2 * index + 1)) {}

    void run(std::int64_t steps) {
        for (std::int64_t i = 0; i < steps; ++i)
            chain.step([this](const Path& path, double weight) { depositor.deposit(path, weight); });
    }
};

/// Steps of each chain between two visits to the stores, so that the chains' buffers stay small beside these.
std::int64_t round_length(std::int64_t photons, std::int64_t chains) {
    return std::clamp<std::int64_t>(photons / (16 * chains), 8, 256);
}

} // namespace

SampledPhotons sample_photons(const std::vector<Path>& seeds, const Mixture<Path>& mixture,
                              const DepositImportance& importance, const PhotonSamplingOptions& options,
                              const RunContext& context) {
    const auto chains = static_cast<std::int64_t>(seeds.size());
    SampledPhotons out;
    if (chains == 0) return out;
    std::vector<std::unique_ptr<ChainRun>> runs(seeds.size());
    parallel_for(chains, [&](std::int64_t c) {
        const auto i = static_cast<std::size_t>(c);
        runs[i] =
            std::make_unique<ChainRun>(seeds[i], mixture, importance, options.seed, static_cast<std::uint64_t>(c));
    });

    // Stores are shared: chains differ in what they find, and thinning must treat all photons alike. The threshold that
    // the run is expected to end with is there from the start.
    const std::int64_t per_chain = std::max<std::int64_t>(1, options.mutations / chains);
    const auto mutations = static_cast<double>(per_chain * chains);
    const auto photons = static_cast<std::int64_t>(options.global_photons + options.caustic_photons);
    const double threshold = std::max(0.2, 0.8 * mutations / static_cast<double>(std::max<std::int64_t>(1, photons)));
    PhotonStore global(options.global_photons, threshold, Rng(options.seed, StreamPurpose::thinning, 0));
    PhotonStore caustic(options.caustic_photons, threshold, Rng(options.seed, StreamPurpose::thinning, 1));
    const auto collect = [&] {
        for (auto& run : runs) {
            global.absorb(run->depositor.global());
            caustic.absorb(run->depositor.caustic());
        }
    };

    // In rounds, so that a stop finds all chains equally long.
    const std::int64_t round = round_length(photons, chains);
    std::int64_t done = 0;
    context.begin("photons", static_cast<std::uint64_t>(per_chain * chains), "mutations");
    while (done < per_chain && !(context.stopped() && done > 0)) {
        const std::int64_t steps = std::min(round, per_chain - done);
        parallel_for(chains, [&](std::int64_t c) {
            ChainRun& run = *runs[static_cast<std::size_t>(c)];
            run.depositor.set_thresholds(global.threshold(), caustic.threshold());
            run.run(steps);
            context.advance(static_cast<std::uint64_t>(steps));
        });
        collect();
        done += steps;
    }
    context.end();
    for (auto& run : runs) run->depositor.flush();
    collect();

    out.steps = static_cast<std::uint64_t>(done * chains);
    const double scale = options.brightness / static_cast<double>(out.steps);
    double lost = 0, total = 0;
    for (auto& run : runs) {
        merge(out.ledger, run->chain.ledger());
        out.longest_stay = std::max(out.longest_stay, run->chain.longest_stay());
        lost += run->depositor.lost_weight();
        total += run->depositor.total_weight();
        run.reset();
    }
    global.release_into(out.global, scale);
    caustic.release_into(out.caustic, scale);
    out.lost_share = total > 0 ? lost / total : 0;
    return out;
}

} // namespace keyhole
