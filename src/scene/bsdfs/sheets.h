// Surfaces without a volume behind them: panes, sheets of paper, and nothing.
#pragma once

#include "scene/bsdfs/fresnel.h"
#include "scene/scattering.h"
#include "scene/warp.h"

namespace keyhole {

/// No surface at all: light goes straight on.
struct InterfaceBsdf {
    static constexpr BsdfTraits traits() { return {.delta = true}; }

    static Rgb eval(const Vec3& /*to_light*/, const Vec3& /*to_eye*/) { return Rgb(0.0); }
    static double pdf(const Vec3& /*from*/, const Vec3& /*to*/) { return 0; }
    static std::optional<BsdfSample> sample(const Vec3& from, double /*u0*/, double /*u1*/, double /*u2*/) {
        return BsdfSample{-from, Event::transmit, 1.0};
    }
    static std::optional<DeltaScatter> delta(const Vec3& from, Event event) {
        if (event != Event::transmit) return std::nullopt;
        return DeltaScatter{-from, Rgb(1.0), 1.0, 1.0};
    }
};

/// A pane of smooth glass, with all reflections between its faces: R' = 2R / (1 + R) (Stokes 1862).
struct ThinDielectricBsdf {
    double eta;

    static constexpr BsdfTraits traits() { return {.delta = true}; }

    double reflectance(const Vec3& from) const {
        const double r = fresnel_dielectric(std::abs(from.z), eta).reflectance;
        return 2 * r / (1 + r);
    }
    static Rgb eval(const Vec3& /*to_light*/, const Vec3& /*to_eye*/) { return Rgb(0.0); }
    static double pdf(const Vec3& /*from*/, const Vec3& /*to*/) { return 0; }
    std::optional<BsdfSample> sample(const Vec3& from, double /*u0*/, double /*u1*/, double u2) const {
        if (from.z == 0) return std::nullopt;
        const double r = reflectance(from);
        if (u2 < r) return BsdfSample{{-from.x, -from.y, from.z}, Event::reflect, r};
        return BsdfSample{-from, Event::transmit, 1 - r};
    }
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const {
        const double r = reflectance(from);
        if (event == Event::reflect) return DeltaScatter{{-from.x, -from.y, from.z}, Rgb(r), r, 1.0};
        if (event != Event::transmit || r == 1) return std::nullopt;
        return DeltaScatter{-from, Rgb(1 - r), 1 - r, 1.0};
    }
};

/// Lambertian reflection and transmission: paper, leaves, lamp shades.
struct DiffuseTransmissionBsdf {
    StoredRgb reflectance, transmittance;

    static constexpr BsdfTraits traits() { return {.finite = true}; }

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
        const double p = pdf(from, to);
        if (!(p > 0)) return std::nullopt;
        return BsdfSample{to, Event::finite, p};
    }
    static std::optional<DeltaScatter> delta(const Vec3& /*from*/, Event /*event*/) { return std::nullopt; }

  private:
    /// The same from both sides and for all directions, so that it is cheap.
    double reflection_probability() const {
        const double r = reflectance.x + reflectance.y + reflectance.z;
        const double t = transmittance.x + transmittance.y + transmittance.z;
        return r + t > 0 ? r / (r + t) : 1.0;
    }
};

} // namespace keyhole
