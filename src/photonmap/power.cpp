#include "photonmap/power.h"

#include "core/integer_power.h"
#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

/// Until the bound follows from the powers that it leaves; each step comes much nearer where outliers are few.
constexpr int kBoundSteps = 8;

} // namespace

double literal_factor(const Path& path, int d2, const Rgb& flux) {
    const int eye = path.vertices() - 1;
    Rgb rest = flux * path.x[eye].value;
    for (int i = d2; i < eye; ++i) rest *= path.x[i].value * geometry_term(path.x[i].point, path.x[i + 1].point);
    const double visible = luminance(rest);
    return visible > 0 && std::isfinite(1 / visible) ? 1 / visible : 0.0;
}

double unit_of_power(const Scene& scene) {
    const double radius = scene.bounding_sphere().radius;
    return power_of_two_near(radius * radius);
}

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
    for (int i = 0; i < kBoundSteps; ++i) left = sum_up_to(outlier_bound(left / n, n));
    const double most = outlier_bound(left / n, n);
    for (Photon& p : photons) {
        const double power = luminance(p.power());
        if (power > most) p.set_power(p.power() * (most / power));
    }
    return 1 - left / all;
}

} // namespace keyhole
