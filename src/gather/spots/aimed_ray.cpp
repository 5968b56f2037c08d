#include "gather/spots/aimed_ray.h"

#include "gather/visible_point.h"
#include "scene/warp.h"

#include <algorithm>

namespace keyhole {
namespace {

/// A ray is drawn for certain where spots may be this share of what is seen.
constexpr double kWorthARay = 0.25;

} // namespace

AimedRay::AimedRay(const HotSpots* spots, const Vertex& v, const Bsdf& lobe, const Vec3& back, double besides,
                   double rays)
    : rays_(rays) {
    if (spots == nullptr || spots->size() == 0) return;
    cones_ = spots->cones_from(v.point.p, cache_normal(v, back));
    double all = 0;
    for (const SpotCone& cone : cones_) {
        chances_.push_back(cone.irradiance * luminance(lobe.eval(cone.axis, back)));
        all += chances_.back();
    }
    const double chance = all > 0 ? std::min(1.0, all / (kWorthARay * std::max(besides, 1e-30))) : 0;
    for (double& c : chances_) c *= all > 0 ? chance / all : 0;
}

std::optional<Vec3> AimedRay::sample(SampleSource& source) const {
    if (cones_.empty()) return std::nullopt;
    const auto [u0, u1, u2] = source.take<3>();
    double u = u0;
    for (std::size_t i = 0; i < cones_.size(); ++i) {
        if (u < chances_[i]) return Frame(cones_[i].axis).to_world(uniform_cone(u1, u2, cones_[i].cos_half_angle));
        u -= chances_[i];
    }
    return std::nullopt;
}

double AimedRay::density(const Vec3& w, double pdf) const {
    double sum = rays_ * pdf;
    for (std::size_t i = 0; i < cones_.size(); ++i)
        if (in_cone(w, cones_[i].axis, cones_[i].cos_half_angle)) sum += chances_[i] / cones_[i].solid_angle();
    return sum;
}

} // namespace keyhole
