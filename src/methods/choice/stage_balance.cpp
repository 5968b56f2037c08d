#include "methods/choice/stage_balance.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

/// CPU time of stages [s].
double seconds_of(Stage::Work work, const RenderStats& stats) {
    double seconds = 0;
    for (const StageStats& s : stats.stages)
        if (s.stage->work == work) seconds += s.cpu_seconds;
    return seconds;
}

} // namespace

StageBalance rebalance(const StageBalance& balance, const RenderStats& stats) {
    const double one = seconds_of(Stage::Work::brightness, stats), two = seconds_of(Stage::Work::chains, stats);
    if (!stats.agreement || !(stats.agreement->error > 0 && stats.brightness > 0 && one > 0 && two > 0)) return balance;
    const double to_one = stats.brightness_error / stats.brightness * std::sqrt(one);
    const double to_two = stats.agreement->error * std::sqrt(two);
    const double share = to_one / (to_one + to_two);
    // Bounds, for what short renders say of their errors is vague; and groups of chains that agree too well, as those
    // do that have not mixed, think their error smaller than it is.
    return {std::clamp(balance.brightness * share * (one + two) / one, 0.25, 1.2),
            std::clamp(balance.chains * (1 - share) * (one + two) / two, 0.9, 4.0)};
}

} // namespace keyhole
