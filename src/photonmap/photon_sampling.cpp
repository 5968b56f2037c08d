#include "photonmap/photon_sampling.h"

#include "core/parallel.h"

#include <memory>
#include <utility>

namespace keyhole {
namespace {

/// A chain with its photon stores.
struct ChainRun {
    Chain<Path> chain;
    PhotonStore global, caustic;
    PathDepositor depositor;

    ChainRun(const Path& seed, const Mixture<Path>& mixture, const DepositImportance& importance,
             const PhotonSamplingOptions& options, std::int64_t index, std::int64_t chains)
        : chain(seed, mixture, stream(options, index, 0)),
          global(capacity(options.global_photons, index, chains), 0, stream(options, index, 1)),
          caustic(capacity(options.caustic_photons, index, chains), 0, stream(options, index, 2)),
          depositor(importance, global, caustic) {}

    static Rng stream(const PhotonSamplingOptions& options, std::int64_t index, std::uint64_t which) {
        return {options.seed, StreamPurpose::chain, 3 * static_cast<std::uint64_t>(index) + which};
    }
    static std::size_t capacity(std::size_t total, std::int64_t index, std::int64_t chains) {
        return static_cast<std::size_t>(split(static_cast<std::int64_t>(total), chains, index).size());
    }

    void run(std::int64_t steps) {
        for (std::int64_t i = 0; i < steps; ++i)
            chain.step([this](const Path& path, double weight) { depositor.deposit(path, weight); });
    }
};

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
        runs[i] = std::make_unique<ChainRun>(seeds[i], mixture, importance, options, c, chains);
    });

    // In rounds, so that a stop finds all chains equally long.
    constexpr std::int64_t kRound = 200;
    const std::int64_t per_chain = std::max<std::int64_t>(1, options.mutations / chains);
    std::int64_t done = 0;
    context.begin("photons", static_cast<std::uint64_t>(per_chain * chains), "mutations");
    while (done < per_chain && !(context.stopped() && done > 0)) {
        const std::int64_t steps = std::min(kRound, per_chain - done);
        parallel_for(chains, [&](std::int64_t c) {
            runs[static_cast<std::size_t>(c)]->run(steps);
            context.advance(static_cast<std::uint64_t>(steps));
        });
        done += steps;
    }
    context.end();

    out.steps = static_cast<std::uint64_t>(done * chains);
    const double scale = options.brightness / static_cast<double>(out.steps);
    double lost = 0, total = 0;
    for (auto& run : runs) {
        run->depositor.flush();
        run->global.release_into(out.global, scale);
        run->caustic.release_into(out.caustic, scale);
        merge(out.ledger, run->chain.ledger());
        out.longest_stay = std::max(out.longest_stay, run->chain.longest_stay());
        lost += run->depositor.lost_weight();
        total += run->depositor.total_weight();
        run.reset();
    }
    out.lost_share = total > 0 ? lost / total : 0;
    return out;
}

} // namespace keyhole
