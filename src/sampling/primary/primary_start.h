// Where chains in primary sample space begin, and how bright the picture is.
#pragma once

#include "core/progress.h"
#include "core/statistics.h"
#include "sampling/primary/technique_change.h"

#include <vector>

namespace keyhole {

/// First state of a chain: an independent sample, by its index, and for multiplexed builders the number that chooses
/// the technique.
struct PrimarySeed {
    std::int64_t sample;
    double choice; ///< negative: the sample's own
};

/// A part of the picture with chains of its own.
struct PrimaryStratum {
    std::unique_ptr<PathBuilder> builder;
    RunningStats brightness; ///< mean luminance over the window, by independent samples; they are chains' seeds, too
    double worth = 1;        ///< large steps of a chain that tell as much about it as one of these samples
    std::vector<PrimarySeed> seeds;
    std::optional<TechniqueChange> change; ///< a further move of its chains
};

struct PrimaryStartOptions {
    std::int64_t samples = 100'000; ///< over all
    std::int64_t chains = 1000;     ///< over all strata, in proportion to their brightness
    std::uint64_t seed = 1;
};

/// The random source of independent sample `index`.
struct PrimaryRandom {
    Rng eye, light, choice;
    PrimaryRandom(std::uint64_t seed, std::int64_t index);
    PrimarySources sources() { return {eye, light, choice}; }
};

/// One stratum, sampled by the builder itself. No seeds if no sample found light.
PrimaryStratum start_whole(std::unique_ptr<PathBuilder> builder, const PrimaryStartOptions& options,
                           const RunContext& context);

/// One stratum for each number of scatterings, with a multiplexed builder. Bidirectional path tracing samples them all
/// at once; each of its joints is a state of one of them. Those that found no light are left out. `inverses`: chains
/// change techniques by inverse mappings, too; may be null, and must outlive the strata.
std::vector<PrimaryStratum> start_by_length(const BuilderContext& builders, const EmitterInverse* inverses,
                                            const PrimaryStartOptions& options, const RunContext& context);

} // namespace keyhole
