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

/// What a render by the method of `cost` with so much effort takes.
double predicted(const Experience& cost, Settings settings, const std::set<std::string>& given,
                 const StageBalance& balance, double pixels, double effort) {
    settings.method = cost.settings.method;
    return cost.predict(with_effort(settings, effort, static_cast<std::int64_t>(pixels), given, balance), pixels);
}

} // namespace

double cost_of_given(const Experience& cost, const Settings& settings, const std::set<std::string>& given,
                     double pixels) {
    return predicted(cost, settings, given, {}, pixels, kLeastEffort) -
           predicted(cost, settings, {}, {}, pixels, kLeastEffort);
}

double affordable_effort(const Experience& cost, const Settings& settings, const std::set<std::string>& given,
                         const StageBalance& balance, double pixels, double seconds) {
    const auto of_effort = [&](double effort) { return predicted(cost, settings, given, balance, pixels, effort); };
    const double named = cost_of_given(cost, settings, given, pixels);
    if (named > (1 - kForOthers) * seconds) seconds = std::max(seconds, of_effort(kLeastEffort) + kForOthers * seconds);
    double least = kLeastEffort, most = kMostGrowth * cost.effort;
    if (of_effort(least) > seconds) return least;
    if (of_effort(most) <= of_effort(least)) return cost.effort; // all that effort is was given
    while (most - least > 0.01 * least) {
        const double effort = (least + most) / 2;
        (of_effort(effort) < seconds ? least : most) = effort;
    }
    return least;
}

} // namespace keyhole
