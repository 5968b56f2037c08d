// Mirrors, and metals, smooth and rough.
#pragma once

#include "scene/bsdfs/fresnel.h"
#include "scene/bsdfs/microfacet.h"
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
        return BsdfSample{mirrored(from), Event::reflect, 1.0};
    }
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const {
        if (event != Event::reflect) return std::nullopt;
        return DeltaScatter{mirrored(from), reflectance, 1.0, 1.0};
    }
};

/// Smooth metal, on both sides.
struct ConductorBsdf {
    ComplexIndex index;

    static constexpr BsdfTraits traits() { return {.delta = true}; }

    static Rgb eval(const Vec3& /*to_light*/, const Vec3& /*to_eye*/) { return Rgb(0.0); }
    static double pdf(const Vec3& /*from*/, const Vec3& /*to*/) { return 0; }

    static std::optional<BsdfSample> sample(const Vec3& from, double /*u0*/, double /*u1*/, double /*u2*/) {
        if (from.z == 0) return std::nullopt;
        return BsdfSample{mirrored(from), Event::reflect, 1.0};
    }
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const {
        if (event != Event::reflect) return std::nullopt;
        return DeltaScatter{mirrored(from), fresnel_conductor(std::abs(from.z), index), 1.0, 1.0};
    }
};

/// Rough metal: GGX microfacets that reflect once (Cook and Torrance 1982), on both sides.
struct RoughConductorBsdf {
    ComplexIndex index;
    float alpha_x, alpha_y; ///< at least kSmoothAlpha / 10
    float scale = 1;        ///< of the value: makes up for what a wider lobe loses by single reflections, on average

    static constexpr BsdfTraits traits() { return {.finite = true, .glossy = true}; }

    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const;
    double pdf(const Vec3& from, const Vec3& to) const;
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double u2) const;
    static std::optional<DeltaScatter> delta(const Vec3& /*from*/, Event /*event*/) { return std::nullopt; }
    Rgb albedo(const Vec3& to_eye) const;
    RoughConductorBsdf widened(double alpha) const;
};

} // namespace keyhole
