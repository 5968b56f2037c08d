#include "scene/emitters/emission_profile.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

double squared_sine(double angle) {
    const double s = std::sin(angle);
    return s * s;
}

} // namespace

EmissionProfile EmissionProfile::grid(double spread_degrees) {
    return spread_degrees < 180 ? EmissionProfile(Kind::grid, 0, spread_degrees * kPi / 360) : EmissionProfile();
}

EmissionProfile EmissionProfile::cone(double full_degrees, double edge_degrees) {
    return {Kind::cone, full_degrees * kPi / 180, edge_degrees * kPi / 180};
}

EmissionProfile::EmissionProfile(Kind kind, double inner, double reach)
    : kind_(kind), tangent_(std::tan(reach)), cos_full_(std::cos(inner)), cos_edge_(std::cos(reach)), reach_(reach),
      projected_(power_within(squared_sine(reach))) {}

double EmissionProfile::through_grid(double cosine) const {
    if (cosine <= cos_edge_) return 0;
    return std::max(0.0, 1 - std::sqrt(std::max(0.0, 1 - cosine * cosine)) / (cosine * tangent_));
}

double EmissionProfile::power_within(double sine2) const {
    if (kind_ == Kind::lambertian) return kPi * sine2;
    sine2 = std::min(sine2, squared_sine(reach_));
    const double cosine = std::sqrt(1 - sine2);
    if (kind_ == Kind::grid) {
        const double sine = std::sqrt(sine2), angle = std::asin(sine);
        return kPi * (sine2 - (angle - sine * cosine) / tangent_);
    }
    if (cosine >= cos_full_ || cos_full_ == cos_edge_) return kPi * sine2;
    // The integral of smoothstep(t) c dc, with c = edge + width t, from t(cosine) to 1.
    const double width = cos_full_ - cos_edge_, t = (cosine - cos_edge_) / width;
    const auto integral = [&](double x) {
        return width * x * x * x * (cos_edge_ * (1 - x / 2) + width * x * (0.75 - 0.4 * x));
    };
    return kPi * (1 - cos_full_ * cos_full_) + 2 * kPi * (integral(1) - integral(t));
}

double EmissionProfile::share_within(double sine2) const { return power_within(sine2) / projected_; }

double EmissionProfile::sine2_of_share(double share) const {
    if (kind_ == Kind::lambertian) return share;
    double low = 0, high = squared_sine(reach_);
    for (int i = 0; i < 48; ++i) { // bisection
        const double middle = (low + high) / 2;
        (share_within(middle) < share ? low : high) = middle;
    }
    return (low + high) / 2;
}

} // namespace keyhole
