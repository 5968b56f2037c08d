// Scattering by a medium.
#pragma once

#include "scene/scattering.h"
#include "scene/warp.h"

namespace keyhole {

/// What a medium does at a point in it: its scattering coefficient [1/m] times the phase function of Henyey and
/// Greenstein 1941. Such a vertex is a point in space and its measure is volume, so that there is no cosine. Its
/// extinction is here for flight_density().
struct PhaseBsdf {
    StoredRgb scattering, extinction; ///< coefficients [1/m]
    float anisotropy = 0;             ///< g, the mean cosine of the angle by which light is turned: in (-1, 1)

    static constexpr BsdfTraits traits() { return {.finite = true, .glossy = true, .through = true}; }

    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const { return Rgb(scattering) * pdf(to_light, to_eye); }
    double pdf(const Vec3& from, const Vec3& to) const {
        // 1 + g^2 - 2 g cos, without what floats would lose of it where g is nearly 1.
        const double g = anisotropy, a = std::abs(g), off2 = Imath::V3d(g < 0 ? from - to : from + to).length2();
        const double d = (1 - a) * (1 - a) + a * off2;
        return kInvPi / 4 * (1 - g * g) / (d * std::sqrt(d));
    }
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double /*u2*/) const {
        const double g = anisotropy;
        double cosine = 1 - 2 * u0;
        if (std::abs(g) > 1e-6) {
            const double s = (1 - g * g) / (1 + g * cosine);
            cosine = std::clamp((1 + g * g - s * s) / (2 * g), -1.0, 1.0);
        }
        // Unit anew: there is no surface that would end the growth of rounding errors from vertex to vertex.
        const Vec3 to = Frame((-from).normalized()).to_world(spherical(cosine, 2 * kPi * u1)).normalized();
        return finite_sample(to, pdf(from, to));
    }
    static std::optional<DeltaScatter> delta(const Vec3& /*from*/, Event /*event*/) { return std::nullopt; }
    Rgb albedo(const Vec3& /*to_eye*/) const { return scattering; }
};

} // namespace keyhole
