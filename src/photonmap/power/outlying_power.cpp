#include "photonmap/power/outlying_power.h"

#include <algorithm>
#include <limits>

namespace keyhole {
namespace {

/// Until the bound follows from the powers that it leaves; each step comes much nearer where outliers are few.
constexpr int kSteps = 8;

} // namespace

double cut_outlying_power(std::vector<Photon>& photons) {
    const auto n = static_cast<double>(photons.size());
    const auto sum_up_to = [&](double most) {
        double sum = 0;
        for (const Photon& p : photons) sum += std::min(luminance(p.power()), most);
        return sum;
    };
    const double all = sum_up_to(std::numeric_limits<double>::infinity());
    if (!(all > 0)) return 0;
    double left = all;
    for (int i = 0; i < kSteps; ++i) left = sum_up_to(outlier_bound(left / n, n));
    const double most = outlier_bound(left / n, n);
    for (Photon& p : photons) {
        const double power = luminance(p.power());
        if (power > most) p.set_power(p.power() * (most / power));
    }
    return 1 - left / all;
}

} // namespace keyhole
