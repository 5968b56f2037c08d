// The strongest oracle of a proposal: started from the target distribution, one step must leave it there.
#pragma once

#include "core/statistics.h"
#include "sampling/markov/chain.h"
#include "sampling/paths/independent_paths.h"
#include "sampling/proposals/registry.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace keyhole::test {

/// Outcome of an invariance test.
struct Invariance {
    struct Line {
        std::string statistic;
        RunningStats change; ///< of its mean under one step, one entry a path sample
        double z() const { return change.standard_error() > 0 ? change.mean() / change.standard_error() : 0.0; }
    };
    std::vector<Line> lines;
    Ledger ledger;
    std::uint64_t paths = 0;

    /// Largest z of the lines, and what chance may make of it.
    double worst() const;
    static double bound();
    std::string report() const;
};

/// Draws `samples` independent samples of `scene`; each of their paths, weighted with its contribution, is an exact
/// draw from the target. Path tracing alone has too heavy a tail for proposals that find caustics more readily. Applies
/// one step of `mixture` to each and compares statistics before and after (expected values).
Invariance measure_invariance(const Scene& scene, const Mixture<Path>& mixture, PathSet set, std::int64_t samples,
                              std::uint64_t seed, int max_scatterings = 8, Technique technique = Technique::path);

} // namespace keyhole::test
