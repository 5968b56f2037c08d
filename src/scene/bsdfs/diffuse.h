// Lambertian reflection on both sides.
#pragma once

#include "scene/scattering.h"
#include "scene/warp.h"

namespace keyhole {

/// Lambertian reflection: f = reflectance / pi where both directions lie on one side.
struct DiffuseBsdf {
    StoredRgb reflectance;

    static constexpr BsdfTraits traits() { return {.finite = true, .near_lambertian = true}; }

    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const {
        return to_light.z * to_eye.z > 0 ? Rgb(reflectance) * kInvPi : Rgb(0.0);
    }
    static double pdf(const Vec3& from, const Vec3& to) { return from.z * to.z > 0 ? std::abs(to.z) * kInvPi : 0.0; }

    static std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double /*u2*/) {
        Vec3 to = cosine_hemisphere(u0, u1);
        if (from.z < 0) to.z = -to.z;
        const double p = pdf(from, to);
        if (p <= 0) return std::nullopt;
        return BsdfSample{to, Event::finite, p};
    }
    static std::optional<DeltaScatter> delta(const Vec3& /*from*/, Event /*event*/) { return std::nullopt; }
};

} // namespace keyhole
