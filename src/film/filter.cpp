#include "film/filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace keyhole {

PixelFilter::PixelFilter(const Settings& settings) : shape_(settings.filter), radius_(settings.filter_radius) {
    if (radius_ == 0) radius_ = shape_ == FilterShape::box ? 0.5 : 1.0;
    if (shape_ != FilterShape::gaussian) return;
    const double sigma = settings.filter_sigma > 0 ? settings.filter_sigma : radius_;
    scale_ = 1 / (sigma * std::numbers::sqrt2);
    mass_ = std::erf(radius_ * scale_);
}

double PixelFilter::density_1d(double x) const {
    const double r = std::abs(x);
    if (!(r <= radius_)) return 0;
    if (shape_ == FilterShape::box) return 0.5 / radius_;
    if (shape_ == FilterShape::triangle) return (1 - r / radius_) / radius_;
    return scale_ * std::numbers::inv_sqrtpi * std::exp(-r * r * scale_ * scale_) / mass_;
}

/// Inverse of the distribution function.
double PixelFilter::sample_1d(double u) const {
    const double target = std::abs(2 * u - 1); // of the mass up to |x|
    if (shape_ == FilterShape::box) return std::copysign(target * radius_, u - 0.5);
    if (shape_ == FilterShape::triangle) return std::copysign((1 - std::sqrt(1 - target)) * radius_, u - 0.5);
    // The distribution function is concave on [0, radius], so that Newton's method rises from 0 to the root and never
    // passes it but by rounding.
    double x = 0;
    for (int step = 0; step < 60; ++step) {
        const double move = (target - std::erf(x * scale_) / mass_) / (2 * density_1d(x));
        if (!(move > 1e-9 * radius_)) break;
        x = std::min(x + move, radius_);
    }
    return std::copysign(x, u - 0.5);
}

Vec2 PixelFilter::sample_offset(double u0, double u1) const {
    return {static_cast<float>(sample_1d(u0)), static_cast<float>(sample_1d(u1))};
}

double PixelFilter::density(const Vec2& offset) const { return density_1d(offset.x) * density_1d(offset.y); }

} // namespace keyhole
