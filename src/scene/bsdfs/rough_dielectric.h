// Rough boundary between two dielectrics.
#pragma once

#include "scene/bsdfs/microfacet.h"
#include "scene/scattering.h"

namespace keyhole {

/// Ground glass: GGX microfacets that reflect or refract once (Walter et al. 2007, with height-correlated masking).
/// `eta` is the refractive index below the normal over that above, and not close to 1.
struct RoughDielectricBsdf {
    float eta, alpha_x, alpha_y;

    static constexpr BsdfTraits traits() { return {.finite = true}; }

    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const;
    double pdf(const Vec3& from, const Vec3& to) const;
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double u2) const;
    static std::optional<DeltaScatter> delta(const Vec3& /*from*/, Event /*event*/) { return std::nullopt; }
};

} // namespace keyhole
