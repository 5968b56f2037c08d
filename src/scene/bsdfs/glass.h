// Smooth boundary between two dielectrics.
#pragma once

#include "scene/scattering.h"

namespace keyhole {

/// Smooth glass. `eta` is the refractive index inside (below the normal) over that outside. Reflection and transmission
/// are chosen by the Fresnel reflectance, which is the same from both ends of a path.
struct GlassBsdf {
    double eta;
    StoredRgb reflect_tint{Rgb(1.0)};
    StoredRgb transmit_tint{Rgb(1.0)};

    static constexpr BsdfTraits traits() { return {.delta = true}; }

    static Rgb eval(const Vec3& /*to_light*/, const Vec3& /*to_eye*/) { return Rgb(0.0); }
    static double pdf(const Vec3& /*from*/, const Vec3& /*to*/) { return 0; }
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double u2) const;
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const;
};

} // namespace keyhole
