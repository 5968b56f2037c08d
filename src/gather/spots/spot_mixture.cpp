#include "gather/spots/spot_mixture.h"

#include "scene/warp.h"

#include <algorithm>

namespace keyhole {
namespace {

/// What spots are thought to bring is a guess: the BSDF draws half of the rays at least.
constexpr double kMostAimed = 0.5;

} // namespace

SpotMixture::SpotMixture(const HotSpots& spots, const Vec3& p, const Vec3& normal, double irradiance) {
    spots.for_each_cone(p, normal, [&](const SpotCone& cone) {
        if (!(cone.irradiance > 0)) return;
        cones_.push_back({cone.axis, cone.cos_half_angle, cone.irradiance, 1 / cone.solid_angle()});
        irradiance_ += cone.irradiance;
    });
    if (irradiance_ > 0) aimed_ = std::min(kMostAimed, irradiance_ / (irradiance_ + irradiance));
}

Vec3 SpotMixture::sample(SampleSource& source) const {
    const auto [u0, u1, u2] = source.take<3>();
    double left = u0 * irradiance_;
    const Cone* chosen = cones_.begin();
    for (const Cone& cone : cones_) {
        chosen = &cone;
        if ((left -= cone.irradiance) < 0) break;
    }
    return Frame(chosen->axis).to_world(uniform_cone(u1, u2, chosen->cos_half_angle));
}

double SpotMixture::density(const Vec3& w, double pdf) const {
    double sum = 0;
    for (const Cone& cone : cones_)
        if (in_cone(w, cone.axis, cone.cos_half_angle)) sum += cone.irradiance * cone.pdf;
    return (1 - aimed_) * pdf + (sum > 0 ? aimed_ * sum / irradiance_ : 0);
}

} // namespace keyhole
