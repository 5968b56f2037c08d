#include "methods/choice/affordable.h"

namespace keyhole {
namespace {

/// What one render shows of costs isn't stretched further than to so many times its effort.
constexpr double kMostGrowth = 1000;

} // namespace

double affordable_effort(const Experience& cost, const Settings& settings, const std::set<std::string>& given,
                         const StageBalance& balance, double pixels, double seconds, double least) {
    Settings of_method = settings;
    of_method.method = cost.settings.method;
    const auto predicted = [&](double effort) {
        return cost.predict(with_effort(of_method, effort, static_cast<std::int64_t>(pixels), given, balance), pixels);
    };
    double most = kMostGrowth * cost.effort;
    if (predicted(least) > seconds) return least;
    if (predicted(most) <= predicted(least)) return cost.effort; // all that effort is was given
    while (most - least > 0.01 * least) {
        const double effort = (least + most) / 2;
        (predicted(effort) < seconds ? least : most) = effort;
    }
    return least;
}

} // namespace keyhole
