// Smooth boundary between two dielectrics.
#pragma once

#include "scene/scattering.h"

namespace keyhole {

/// Fresnel reflectance of unpolarised light at a smooth dielectric boundary, and the cosine of refraction.
struct FresnelResult {
    double reflectance; ///< 1 under total internal reflection
    double cos_t;       ///< |cos| on the far side; 0 under total internal reflection
};

/// `cos_i` > 0 on the near side; `eta` is the far refractive index over the near one.
FresnelResult fresnel_dielectric(double cos_i, double eta);

/// Smooth glass. `eta` is the refractive index inside (below the normal) over that outside. Reflection and transmission
/// are chosen by the Fresnel reflectance, which is the same from both ends of a path.
struct GlassBsdf {
    double eta;
    Rgb reflect_tint{1.0};
    Rgb transmit_tint{1.0};

    static constexpr BsdfTraits traits() { return {.delta = true}; }

    static Rgb eval(const Vec3& /*to_light*/, const Vec3& /*to_eye*/) { return Rgb(0.0); }
    static double pdf(const Vec3& /*from*/, const Vec3& /*to*/) { return 0; }
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double u2) const;
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const;
};

} // namespace keyhole
