// Lambertian reflection on both sides, and transmission.
#pragma once

#include "scene/scattering.h"
#include "scene/warp.h"

namespace keyhole {

/// Lambertian reflection: f = reflectance / pi where both directions lie on one side.
struct DiffuseBsdf {
    StoredRgb reflectance;

    static constexpr BsdfTraits traits() { return {.finite = true, .diffuse = true}; }

    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const {
        return to_light.z * to_eye.z > 0 ? Rgb(reflectance) * kInvPi : Rgb(0.0);
    }
    static double pdf(const Vec3& from, const Vec3& to) { return from.z * to.z > 0 ? std::abs(to.z) * kInvPi : 0.0; }

    static std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double /*u2*/) {
        Vec3 to = cosine_hemisphere(u0, u1);
        if (from.z < 0) to.z = -to.z;
        return finite_sample(to, pdf(from, to));
    }
    static std::optional<DeltaScatter> delta(const Vec3& /*from*/, Event /*event*/) { return std::nullopt; }

    Rgb albedo(const Vec3& /*to_eye*/) const { return reflectance; }
    Rgb diffuse_reflectance(const Vec3& /*to_eye*/) const { return Rgb(reflectance) * kInvPi; }
    static double diffuse_weight(const Vec3& /*to_light*/) { return 1; }
};

/// Lambertian reflection and transmission: paper, leaves, lamp shades. Light from behind is no part of the irradiance
/// in front, so that all of it counts as glossy.
struct DiffuseTransmissionBsdf {
    StoredRgb reflectance, transmittance;

    static constexpr BsdfTraits traits() { return {.finite = true, .glossy = true, .through = true}; }

    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const {
        const double sides = static_cast<double>(to_light.z) * to_eye.z;
        if (sides == 0) return Rgb(0.0);
        return Rgb(sides > 0 ? reflectance : transmittance) * kInvPi;
    }
    double pdf(const Vec3& from, const Vec3& to) const {
        const double sides = static_cast<double>(from.z) * to.z, p = reflection_probability();
        if (sides == 0) return 0;
        return (sides > 0 ? p : 1 - p) * std::abs(to.z) * kInvPi;
    }
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double u2) const {
        Vec3 to = cosine_hemisphere(u0, u1);
        const bool reflects = u2 < reflection_probability();
        if ((from.z > 0) != reflects) to.z = -to.z;
        return finite_sample(to, pdf(from, to));
    }
    static std::optional<DeltaScatter> delta(const Vec3& /*from*/, Event /*event*/) { return std::nullopt; }
    Rgb albedo(const Vec3& /*to_eye*/) const { return Rgb(reflectance) + Rgb(transmittance); }

  private:
    /// The same from both sides and for all directions, so that it is cheap.
    double reflection_probability() const {
        const double r = reflectance.x + reflectance.y + reflectance.z;
        const double t = transmittance.x + transmittance.y + transmittance.z;
        return r + t > 0 ? r / (r + t) : 1.0;
    }
};

} // namespace keyhole
