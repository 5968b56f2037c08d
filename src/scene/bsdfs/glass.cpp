#include "scene/bsdfs/glass.h"

#include <algorithm>

namespace keyhole {

FresnelResult fresnel_dielectric(double cos_i, double eta) {
    const double sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return {1.0, 0.0};
    const double cos_t = std::sqrt(1 - sin2_t);
    const double parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const double perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return {(parallel * parallel + perpendicular * perpendicular) / 2, cos_t};
}

std::optional<BsdfSample> GlassBsdf::sample(const Vec3& from, double /*u0*/, double /*u1*/, double u2) const {
    const double relative = from.z > 0 ? eta : 1 / eta;
    const Event event =
        u2 < fresnel_dielectric(std::abs(from.z), relative).reflectance ? Event::reflect : Event::transmit;
    const auto lobe = delta(from, event);
    if (!lobe || is_black(lobe->coefficient)) return std::nullopt;
    return BsdfSample{lobe->to, event, lobe->probability};
}

std::optional<DeltaScatter> GlassBsdf::delta(const Vec3& from, Event event) const {
    if (from.z == 0) return std::nullopt;
    const double relative = from.z > 0 ? eta : 1 / eta;
    const auto [reflectance, cos_t] = fresnel_dielectric(std::abs(from.z), relative);
    if (event == Event::reflect) {
        return DeltaScatter{{-from.x, -from.y, from.z}, reflect_tint * reflectance, reflectance, 1.0};
    }
    if (event != Event::transmit || cos_t == 0) return std::nullopt;
    const auto inverse = static_cast<float>(-1 / relative);
    Vec3 to(from.x * inverse, from.y * inverse, static_cast<float>(from.z > 0 ? -cos_t : cos_t));
    to.normalize();
    return DeltaScatter{to, transmit_tint * (1 - reflectance), 1 - reflectance, relative};
}

} // namespace keyhole
