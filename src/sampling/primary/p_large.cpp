#include "sampling/primary/p_large.h"

#include <algorithm>

namespace keyhole {

LargeStepRule large_step_rule(const PrimaryCounts& counts) {
    LargeStepRule rule{counts.small.mean_acceptance(), counts.large.mean_acceptance(), 1 - counts.large.failure_rate(),
                       false, 0.25};
    rule.by_formula = rule.eta_l > 0.1 * rule.eta_0;
    if (!rule.by_formula) return rule;
    const double gain = rule.eta_s - rule.eta_l;
    rule.p_large = gain > 0 ? std::min(1.0, rule.eta_s / (2 * gain)) : 1.0;
    return rule;
}

} // namespace keyhole
