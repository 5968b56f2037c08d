// Boundaries between two dielectrics, smooth and rough; panes, and no boundary at all.
#pragma once

#include "scene/bsdfs/fresnel.h"
#include "scene/bsdfs/microfacet.h"
#include "scene/scattering.h"

namespace keyhole {

/// Smooth glass. `eta` is the refractive index inside (below the normal) over that outside. Reflection and transmission
/// are chosen by the Fresnel reflectance, which is the same from both ends of a path.
struct GlassBsdf {
    double eta;
    StoredRgb reflect_tint{Rgb(1.0)};
    StoredRgb transmit_tint{Rgb(1.0)};

    static constexpr BsdfTraits traits() { return {.delta = true, .clear = ClearGlass::face}; }

    static Rgb eval(const Vec3& /*to_light*/, const Vec3& /*to_eye*/) { return Rgb(0.0); }
    static double pdf(const Vec3& /*from*/, const Vec3& /*to*/) { return 0; }
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double u2) const;
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const;
};

/// Ground glass: GGX microfacets that reflect or refract once (Walter et al. 2007, with height-correlated masking).
/// `eta` is the refractive index below the normal over that above, and not close to 1.
struct RoughDielectricBsdf {
    float eta, alpha_x, alpha_y;
    StoredRgb reflect_tint{Rgb(1.0)};
    StoredRgb transmit_tint{Rgb(1.0)};

    static constexpr BsdfTraits traits() { return {.finite = true, .glossy = true, .through = true}; }

    Rgb eval(const Vec3& to_light, const Vec3& to_eye) const;
    double pdf(const Vec3& from, const Vec3& to) const;
    std::optional<BsdfSample> sample(const Vec3& from, double u0, double u1, double u2) const;
    static std::optional<DeltaScatter> delta(const Vec3& /*from*/, Event /*event*/) { return std::nullopt; }
    Rgb albedo(const Vec3& to_eye) const;
};

/// No surface at all: light goes straight on.
struct InterfaceBsdf {
    static constexpr BsdfTraits traits() { return {.delta = true, .clear = ClearGlass::pane}; }

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

/// A pane of smooth glass, with all reflections between its faces: R' = 2R / (1 + R) (Stokes 1862). What goes through
/// has the tint.
struct ThinDielectricBsdf {
    double eta;
    StoredRgb transmit_tint{Rgb(1.0)};

    static constexpr BsdfTraits traits() { return {.delta = true, .clear = ClearGlass::pane}; }

    double reflectance(const Vec3& from) const {
        const double r = fresnel_dielectric(std::abs(from.z), eta).reflectance;
        return 2 * r / (1 + r);
    }
    static Rgb eval(const Vec3& /*to_light*/, const Vec3& /*to_eye*/) { return Rgb(0.0); }
    static double pdf(const Vec3& /*from*/, const Vec3& /*to*/) { return 0; }
    std::optional<BsdfSample> sample(const Vec3& from, double /*u0*/, double /*u1*/, double u2) const {
        if (from.z == 0) return std::nullopt;
        const double r = reflectance(from);
        if (u2 < r) return BsdfSample{mirrored(from), Event::reflect, r};
        return BsdfSample{-from, Event::transmit, 1 - r};
    }
    std::optional<DeltaScatter> delta(const Vec3& from, Event event) const {
        const double r = reflectance(from);
        if (event == Event::reflect) return DeltaScatter{mirrored(from), Rgb(r), r, 1.0};
        if (event != Event::transmit || r == 1) return std::nullopt;
        return DeltaScatter{-from, Rgb(transmit_tint) * (1 - r), 1 - r, 1.0};
    }
};

} // namespace keyhole
