// Photons of chains over light sub-paths.
#pragma once

#include "core/progress.h"
#include "core/statistics.h"
#include "photonmap/photon_weighing.h"
#include "photonmap/photons.h"
#include "sampling/primary/p_large.h"
#include "sampling/primary/primary_kernel.h"
#include "scene/scene.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace keyhole {

struct LightChainOptions {
    std::int64_t samples;          ///< independent ones to start from
    std::int64_t chains;           ///< pilot photons included
    std::int64_t mutations;        ///< over all chains
    std::size_t photons;           ///< ceiling for both maps together; they share it as they share the weight
    std::optional<double> p_large; ///< probability of large steps; none: learnt
    bool mis_of_large_steps = true;
    StorageRule rule{};
    std::uint64_t seed;
};

/// What independent samples say.
struct LightChainStart {
    /// For chains of one role, by the samples that are theirs.
    struct Part {
        std::vector<std::int64_t> seeds; ///< samples that chains start from
        RunningStats target;
    };
    Part pilots, main_photons;
    PhotonWeights weights;
    std::int64_t samples = 0; ///< that were made
};

/// Samples light sub-paths independently. After a stop, as many as were made. Memory for a million of them at most is
/// taken, and more are not made: large steps of the chains go on with them.
LightChainStart start_light_chains(const Scene& scene, const EmissionGuide& guide, const LightChainOptions& options,
                                   const RunContext& context);

struct LightChainPhotons : Photons {
    std::size_t bytes = 0; ///< of the stores
    std::int64_t chains = 0;
    PrimaryCounts counts;     ///< of all chains
    LargeStepRule rule{};     ///< after the first batch
    double p_large = 0;       ///< that was used
    RunningStats target;      ///< of main photons, by independent samples and large steps
    std::uint64_t broken = 0; ///< candidates with a value that was not a number
};

/// Metropolis chains in primary sample space (Kelemen et al. 2002) whose states are light sub-paths, as in Hachisuka
/// and Jensen 2011 ("Robust Adaptive Photon Tracing Using Photon Path Visibility"), but with target Y(f_map E), read
/// from the guide, in place of visibility. Each state leaves its power over target at all its vertices where a map can
/// be asked, so that E decides where photons are and biases nothing; where E is unknown, a share of the target by power
/// keeps them possible. Large steps deposit on their own account as in PrimaryChains. `guide.global` must be given.
///
/// The result is the same on any number of threads. After a stop every chain has made the same number of steps.
LightChainPhotons run_light_chains(const Scene& scene, const EmissionGuide& guide, const LightChainStart& start,
                                   const LightChainOptions& options, const RunContext& context);

} // namespace keyhole
