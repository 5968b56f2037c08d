#include "film/filter.h"

#include <cmath>

namespace keyhole {
namespace {

constexpr double kScale = 1.0 / (GaussianFilter::kSigma * std::numbers::sqrt2);

/// Share of the untruncated Gaussian within the support, along one axis.
const double kMass = std::erf(GaussianFilter::kRadius * kScale);

double density_1d(double x) {
    if (!(std::abs(x) <= GaussianFilter::kRadius)) return 0.0;
    const double t = x * kScale;
    return kScale * std::numbers::inv_sqrtpi * std::exp(-t * t) / kMass;
}

/// Inverse of the distribution function. On [0, radius] that function is concave, so Newton's method falls below the
/// root in its first step from the chord and then rises to it; the third step is exact to 1e-14.
double sample_1d(double u) {
    const double target = std::abs(2.0 * u - 1.0);
    double x = target * GaussianFilter::kRadius;
    for (int step = 0; step < 4; ++step) x -= (std::erf(x * kScale) / kMass - target) / (2.0 * density_1d(x));
    return std::copysign(x, u - 0.5);
}

} // namespace

Vec2 GaussianFilter::sample_offset(double u0, double u1) const {
    return {static_cast<float>(sample_1d(u0)), static_cast<float>(sample_1d(u1))};
}

double GaussianFilter::density(const Vec2& offset) const { return density_1d(offset.x) * density_1d(offset.y); }

} // namespace keyhole
