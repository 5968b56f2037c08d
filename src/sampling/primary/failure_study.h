// What leaving out failed proposals does, on the real line: the one-dimensional study of Zeng and Wei 2019 and one that
// shows its limits.
#pragma once

#include "sampling/primary/primary_kernel.h"

#include <vector>

namespace keyhole {

/// Chains of `proposals` proposals each, started from the target, whose histograms are compared with it.
struct FailureStudy {
    enum class Target {
        normal,     ///< mean 3, deviation 2; proposals fail with probability `failure`, wherever they start and land
        half_normal ///< its upper half; proposals below 3 fail, so that many do near 3 and few far away
    };
    Target target = Target::normal;
    double failure = 0.4;
    Failures failures = Failures::reject;
    double p_large = 0; ///< large steps are uniform over the bins
    int proposals = 1600;
    int repeats = 100;
    std::uint64_t seed = 1;
};

/// Errors of histograms of probability, over 52 bins of width 1/4 about the mean.
struct FailureStudyResult {
    double rmse = 0;            ///< root mean square error over bins and repeats
    double bias = 0;            ///< the part of it that is the same in all repeats; its noise is taken off
    double deviation = 0;       ///< the rest
    double failure_rate = 0;    ///< failed proposals, delayed ones apart
    double acceptance_rate = 0; ///< accepted candidates, of all proposals
    double remedied = 0;        ///< delayed ones that did not fail, of all proposals
};

/// The paper gives neither its bins nor its step: small steps are normal of deviation 2, the target's own, and with
/// these bins the four numbers of its table 2 come out.
FailureStudyResult run_failure_study(const FailureStudy& study);

} // namespace keyhole
