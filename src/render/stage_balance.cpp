#include "render/stage_balance.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string_view>

namespace keyhole {
namespace {

/// CPU time of some stages [s].
double seconds_of(const RenderStats& stats, std::initializer_list<std::string_view> names) {
    double seconds = 0;
    for (const StageStats& stage : stats.stages)
        if (std::find(names.begin(), names.end(), stage.name) != names.end()) seconds += stage.cpu_seconds;
    return seconds;
}

} // namespace

StageBalance rebalance(const StageBalance& balance, const RenderStats& stats) {
    const auto chains = stats.values.find("chains, error of block brightness");
    const double one = seconds_of(stats, {"brightness"}), two = seconds_of(stats, {"photons", "chains"});
    if (chains == stats.values.end() || !(chains->second > 0 && stats.brightness > 0 && one > 0 && two > 0))
        return balance;
    const double to_one = stats.brightness_error / stats.brightness * std::sqrt(one);
    const double to_two = chains->second * std::sqrt(two);
    const double share = to_one / (to_one + to_two);
    // Bounds, for what short renders say of their errors is vague; and groups of chains that agree too well, as those
    // do that have not mixed, think their error smaller than it is.
    return {std::clamp(balance.brightness * share * (one + two) / one, 0.25, 1.2),
            std::clamp(balance.chains * (1 - share) * (one + two) / two, 0.9, 4.0)};
}

} // namespace keyhole
