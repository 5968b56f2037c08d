// Where chains in primary sample space begin, and how bright the picture is.
#pragma once

#include "core/progress.h"
#include "core/statistics.h"
#include "sampling/primary/reversible_jump.h"

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
    double large_steps_per_sample = 1; ///< large steps of a chain that tell as much about it as one of these samples
    std::vector<PrimarySeed> seeds;
    std::optional<ReversibleJump> change; ///< a further move of its chains
};

struct PrimaryStartOptions {
    std::int64_t samples = 100'000; ///< over all
    std::uint64_t seed = 1;
};

/// The random source of independent sample `index`.
struct PrimaryRandom {
    Rng eye, light, choice;
    PrimaryRandom(std::uint64_t seed, std::int64_t index);
    PrimarySources sources() { return {eye, light, choice}; }
};

/// What independent samples have found: the brightness of each stratum, and where chains may begin.
class PrimaryStart {
  public:
    /// One stratum, sampled by the builder itself.
    static PrimaryStart whole(std::unique_ptr<PathBuilder> builder, const PrimaryStartOptions& options,
                              const RunContext& context);

    /// One stratum for each number of scatterings, with a multiplexed builder. Bidirectional path tracing samples them
    /// all at once; each of its connections is a state of one of them. Those that found no light are left out.
    /// `inverses`: chains change techniques by inverse mappings, too; may be null, and must outlive this.
    static PrimaryStart by_length(const BuilderContext& builders, const EmitterInverse* inverses,
                                  const PrimaryStartOptions& options, const RunContext& context);

    /// The strata with new seeds for `chains` chains, in proportion to the strata's brightness, one at least each. No
    /// strata if no sample found light. `group`: those of different groups are chosen independently of each other.
    const std::vector<PrimaryStratum>& choose_seeds(std::int64_t chains, std::uint64_t group);

  private:
    /// Something that a sample found.
    struct Find {
        std::int64_t sample;
        int stratum; ///< index among strata_
        int s;       ///< technique; 0 where there is nothing to choose
        double luminance;
    };
    struct Block;

    explicit PrimaryStart(std::uint64_t seed) : seed_(seed) {}
    template <class Sample>
    static Block run_samples(std::size_t strata, const PrimaryStartOptions& options, const RunContext& context,
                             Sample&& sample);

    std::uint64_t seed_;
    std::vector<Find> finds_;
    std::vector<PrimaryStratum> strata_;
    std::vector<int> techniques_; ///< of each stratum; 0: the builder chooses
};

} // namespace keyhole
