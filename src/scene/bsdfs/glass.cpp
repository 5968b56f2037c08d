#include "scene/bsdfs/glass.h"

#include "scene/bsdfs/fresnel.h"

namespace keyhole {

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
        return DeltaScatter{{-from.x, -from.y, from.z}, Rgb(reflect_tint) * reflectance, reflectance, 1.0};
    }
    if (event != Event::transmit || cos_t == 0) return std::nullopt;
    const auto inverse = static_cast<float>(-1 / relative);
    Vec3 to(from.x * inverse, from.y * inverse, static_cast<float>(from.z > 0 ? -cos_t : cos_t));
    to.normalize();
    return DeltaScatter{to, Rgb(transmit_tint) * (1 - reflectance), 1 - reflectance, relative};
}

} // namespace keyhole
