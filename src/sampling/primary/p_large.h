// The probability of large steps, learnt.
#pragma once

#include "sampling/primary/primary_kernel.h"

#include <algorithm>
#include <cstdint>

namespace keyhole {

/// What the rule learns from, and what it says.
struct LargeStepRule {
    double eta_s;    ///< acceptance of small steps
    double eta_l;    ///< acceptance of large steps
    double eta_0;    ///< share of large steps that make a path with light
    bool by_formula; ///< false: the second branch
    double p_large;
};

/// The rule of Zsolnai and Szirmay-Kalos ("Automatic Parameter Control for Metropolis Light Transport", 2013):
/// eta_s / (2 (eta_s - eta_l)), at most 1, where large steps that carry light are accepted often enough, eta_l / eta_0
/// > 0.1; else 1/4. Where large steps are accepted no less than small ones, which the formula does not predict, 1.
inline LargeStepRule large_step_rule(const PrimaryCounts& counts) {
    LargeStepRule rule{counts.small.mean_acceptance(), counts.large.mean_acceptance(), 1 - counts.large.failure_rate(),
                       false, 0.25};
    rule.by_formula = rule.eta_l > 0.1 * rule.eta_0;
    if (!rule.by_formula) return rule;
    const double gain = rule.eta_s - rule.eta_l;
    rule.p_large = gain > 0 ? std::min(1.0, rule.eta_s / (2 * gain)) : 1.0;
    return rule;
}

/// Steps of each chain in two batches. The first 32nd part learns how often large steps are accepted and fail, with
/// half of the steps large, and deposits nothing.
struct LearningBatch {
    std::int64_t steps, rest;

    explicit LearningBatch(std::int64_t all)
        : steps(std::max<std::int64_t>(1, all / 32)), rest(std::max<std::int64_t>(1, all - steps)) {}
};

} // namespace keyhole
