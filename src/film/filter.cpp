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
    for (std::size_t i = 0; i < quantiles_.size(); ++i)
        quantiles_[i] = quantile(static_cast<double>(i) / static_cast<double>(quantiles_.size() - 1));
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
    // From between the two known quantiles around it; seldom more than a step. Back at the lower one it rises to the
    // root, as the distribution function is concave.
    const double place = target * static_cast<double>(quantiles_.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(place), quantiles_.size() - 2);
    double x = std::lerp(quantiles_[i], quantiles_[i + 1], place - static_cast<double>(i));
    for (int step = 0; step < 60; ++step) {
        const double move = newton_step(x, target);
        x = std::clamp(x + move, quantiles_[i], quantiles_[i + 1]);
        if (!(std::abs(move) > 1e-5 / scale_)) break; // its square is what is left
    }
    return std::copysign(x, u - 0.5);
}

double PixelFilter::newton_step(double x, double mass) const {
    return (mass - std::erf(x * scale_) / mass_) / (2 * density_1d(x));
}

double PixelFilter::quantile(double mass) const {
    // The distribution function is concave on [0, radius], so that Newton's method rises from 0 to the root and never
    // passes it but by rounding.
    double x = 0;
    for (int step = 0; step < 60; ++step) {
        const double move = newton_step(x, mass);
        if (!(move > 1e-12 * radius_)) break;
        x = std::min(x + move, radius_);
    }
    return x;
}

Vec2 PixelFilter::sample_offset(double u0, double u1) const {
    return {static_cast<float>(sample_1d(u0)), static_cast<float>(sample_1d(u1))};
}

double PixelFilter::density(const Vec2& offset) const { return density_1d(offset.x) * density_1d(offset.y); }

} // namespace keyhole
