// Stage two: chains over whole paths, and the photons they leave.
#pragma once

#include "core/progress.h"
#include "photonmap/deposit.h"
#include "sampling/brightness.h"
#include "sampling/markov/chain_set.h"

#include <vector>

namespace keyhole {

struct PhotonSamplingOptions {
    std::int64_t mutations;      ///< over all chains
    std::size_t global_photons;  ///< ceiling for the global map; 0: none are kept
    std::size_t caustic_photons; ///< ceiling for the caustic map; 0: none are kept
    std::uint64_t seed;
    const Mixture<Path>* control = nullptr; ///< of the control chains, as in ChainSet
};

/// What chains have done.
struct PhotonChains {
    ChainSummary chains;
    PathDepositor::Tally tally;                 ///< of all chains
    double global_scale = 0, caustic_scale = 0; ///< of the weights that they stored
};

struct SampledPhotons : Photons, PhotonChains {
    std::size_t bytes = 0; ///< of the stores
};

/// Where chains start. Pilot photons and main photons come from different samples of stage one.
struct ChainSeeds {
    std::vector<Path> pilots, main_photons;
    double brightness = 0; ///< B_eye [W/(m^2 sr)] by the samples that the main photons' seeds come from
};

/// Seeds for so many chains from a finished stage one.
ChainSeeds choose_chain_seeds(const Scene& scene, const StageOneSettings& settings, const StageOne& stage,
                              std::int64_t chains);

/// Runs one chain from each seed, all equally long, and stores their photons. The number of chains is that of the seeds
/// and never follows the threads: the result is the same on any number of them. After a stop every chain has made the
/// same number of steps.
SampledPhotons sample_photons(const ChainSeeds& seeds, const Mixture<Path>& mixture, const DepositOptions& deposit,
                              const PhotonSamplingOptions& options, const RunContext& context);

/// The same into `stores`; the ceilings among the options say only how often these are visited.
PhotonChains run_photon_chains(const ChainSeeds& seeds, const Mixture<Path>& mixture, const DepositOptions& deposit,
                               const PhotonSamplingOptions& options, MapStores& stores, const RunContext& context);

} // namespace keyhole
