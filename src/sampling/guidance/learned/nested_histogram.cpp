#include "sampling/guidance/learned/nested_histogram.h"

namespace keyhole {
namespace {

/// Of all directions, those of the wider cell.
constexpr double kWiderShare = 0.25;

} // namespace

Vec3 NestedHistogram::sample(const Vec3& p, double u0, double u1) const {
    if (!wider_) return own_.sample(p, u0, u1);
    if (u0 < kWiderShare) return wider_->sample(p, u0 / kWiderShare, u1);
    return own_.sample(p, (u0 - kWiderShare) / (1 - kWiderShare), u1);
}

double NestedHistogram::pdf(const Vec3& p, const Vec3& w) const {
    const DirectionHistogram::Place on_map = DirectionHistogram::place_on_map(w);
    const double own = own_.pdf(p, w, on_map);
    return wider_ ? (1 - kWiderShare) * own + kWiderShare * wider_->pdf(p, w, on_map) : own;
}

} // namespace keyhole
