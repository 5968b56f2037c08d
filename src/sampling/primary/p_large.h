// The probability of large steps, learnt.
#pragma once

#include "sampling/primary/failures.h"

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
/// > 0.1; else 1/4. Where large steps are accepted no less than small ones, which the formula does not foresee, 1.
LargeStepRule large_step_rule(const PrimaryCounts& counts);

} // namespace keyhole
