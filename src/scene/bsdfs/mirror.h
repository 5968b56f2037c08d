// Ideal reflection on both sides.
#pragma once

#include "scene/scattering.h"

namespace keyhole {

/// Smooth mirror with a constant reflectance.
struct MirrorBsdf {
    StoredRgb reflectance;

    static constexpr BsdfTraits traits() { return {.delta = true}; }

    static Rgb eval(const Vec3& /*to_light*/, const Vec3& /*to_eye*/) { return Rgb(0.0); }
    static double pdf(const Vec3& /*from*/, const Vec3& /*to*/) { return 0; }

    std::optional<BsdfSample> sample(const Vec3& from, double /*u0*/, double /*u1*/, double /*u2*/) const {
        if (is_black(reflectance) || from.z == 0) return std::nullopt;
        return BsdfSample{{-from.x, -from.y, from.z}, Event::reflect, 1.0};
    }
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const {
        if (event != Event::reflect) return std::nullopt;
        return DeltaScatter{{-from.x, -from.y, from.z}, reflectance, 1.0, 1.0};
    }
};

} // namespace keyhole
