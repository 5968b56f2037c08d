#include "methods/choice/affordable.h"

#include <algorithm>

namespace keyhole {
namespace {

/// What one render shows of costs isn't stretched further than to so many times its effort.
constexpr double kMostGrowth = 1000;
constexpr double kLeastEffort = 1e-4;
/// Of the time, what everything else gets at least where what was given takes all of it. It ends with the time anyway;
/// without photons there would be no picture.
constexpr double kForOthers = 0.4;

} // namespace

double cost_of_given(const Experience& cost, const Settings& settings, const std::set<std::string>& given,
                     double pixels) {
    Settings of_method = settings;
    of_method.method = cost.settings.method;
    const auto predicted = [&](const std::set<std::string>& kept) {
        return cost.predict(with_effort(of_method, kLeastEffort, static_cast<std::int64_t>(pixels), kept), pixels);
    };
    return predicted(given) - predicted({});
}

double affordable_effort(const Experience& cost, const Settings& settings, const std::set<std::string>& given,
                         const StageBalance& balance, double pixels, double seconds) {
    Settings of_method = settings;
    of_method.method = cost.settings.method;
    const auto predicted = [&](double effort) {
        return cost.predict(with_effort(of_method, effort, static_cast<std::int64_t>(pixels), given, balance), pixels);
    };
    const double named = cost_of_given(cost, settings, given, pixels);
    if (named > (1 - kForOthers) * seconds) seconds = std::max(seconds, predicted(kLeastEffort) + kForOthers * seconds);
    double least = kLeastEffort, most = kMostGrowth * cost.effort;
    if (predicted(least) > seconds) return least;
    if (predicted(most) <= predicted(least)) return cost.effort; // all that effort is was given
    while (most - least > 0.01 * least) {
        const double effort = (least + most) / 2;
        (predicted(effort) < seconds ? least : most) = effort;
    }
    return least;
}

} // namespace keyhole
