// Microfacets with the GGX distribution of slopes.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <optional>

namespace keyhole {

/// Directions in double: a half vector of two floats would not resolve narrow lobes.
using LocalVec = Imath::V3d;

/// Up to this roughness a surface counts as smooth.
constexpr double kSmoothAlpha = 1e-3;

/// Position of x in [0,1] in a table of n entries: the entry to the left, and the share of the one to the right.
struct TablePosition {
    std::size_t i;
    double share;
};
inline TablePosition locate(double x, std::size_t n) {
    const double s = std::clamp(x, 0.0, 1.0) * static_cast<double>(n - 1);
    const auto i = std::min(static_cast<std::size_t>(s), n - 2);
    return {i, s - static_cast<double>(i)};
}
inline double between(double a, double b, double share) { return a + (b - a) * share; }

/// Anisotropic GGX with Smith's masking, around +z (Heitz 2014, "Understanding the Masking-Shadowing Function"). All
/// directions are unit with z > 0 unless said otherwise.
struct Ggx {
    double alpha_x, alpha_y; ///< > 0

    /// Density D of microfacet normals [1/sr], per projected area.
    double density(const LocalVec& h) const;
    /// Lambda of `w`, on either side: masking is 1 / (1 + lambda).
    double lambda(const LocalVec& w) const;
    /// Masking and shadowing, correlated by height, of two directions on any sides.
    double masking(const LocalVec& a, const LocalVec& b) const { return 1 / (1 + lambda(a) + lambda(b)); }
    /// What masking leaves of light that a facet visible from `from` sends along `to`.
    double unmasked(const LocalVec& from, const LocalVec& to) const { return (1 + lambda(from)) * masking(from, to); }
    /// Density per solid angle of the normals visible from `w`.
    double visible_density(const LocalVec& w, const LocalVec& h) const;
    /// Draws a normal visible from `w` (Heitz 2018).
    LocalVec sample_visible(const LocalVec& w, double u0, double u1) const;

    /// Mirrors `w` at a visible normal; none where that leads below the surface.
    std::optional<LocalVec> sample_reflection(const LocalVec& w, double u0, double u1) const;
    /// Density per solid angle of sample_reflection().
    double reflection_pdf(const LocalVec& from, const LocalVec& to) const;
    /// The factor D G / (4 cos cos) of a BRDF.
    double reflection(const LocalVec& a, const LocalVec& b, const LocalVec& h) const;
};

/// Directional albedo of microfacets seen from `w`: the mean of `of(h)` over normals h visible from there, by a few
/// that are always the same. `of` is to be what a facet sends on, masking of the direction it goes to included; as that
/// ends at zero along the horizon, the sum is a smooth function of `w`. Within some percent.
template <class Of> Rgb mean_over_facets(const Ggx& ggx, const LocalVec& w, const Of& of) {
    constexpr int kRings = 6, kAngles = 5;
    Rgb sum(0.0);
    if (!(w.z > 0)) return sum;
    for (int i = 0; i < kRings; ++i) {
        // Narrow near 1, where the distribution's tail is; each is turned against the one before.
        const double t = (i + 0.5) / kRings, share = 2 * t / (kRings * kAngles);
        for (int j = 0; j < kAngles; ++j) sum += of(ggx.sample_visible(w, 1 - t * t, (j + t) / kAngles)) * share;
    }
    return sum;
}

/// The roughness of a lobe that is to be at least so wide; a smooth one stays smooth.
inline float widened_alpha(float alpha, double least) {
    return alpha == 0 ? alpha : std::max(alpha, static_cast<float>(least));
}

/// Unit half vector of two directions, neither opposite to the other.
inline LocalVec half_vector(const LocalVec& a, const LocalVec& b) { return (a + b).normalized(); }

/// `v` on the side z > 0: models that look the same from both sides work there.
inline LocalVec upper(const Vec3& v) { return {v.x, v.y, std::abs(static_cast<double>(v.z))}; }

/// `v`, found on the side z > 0, on the side that `like` is on.
inline Vec3 on_side_of(const Vec3& like, const LocalVec& v) {
    return Vec3(LocalVec(v.x, v.y, like.z < 0 ? -v.z : v.z));
}

} // namespace keyhole
