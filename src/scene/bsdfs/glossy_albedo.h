// How much light the lobes of layered models reflect in all: what the layers below them may have.
#pragma once

namespace keyhole {

/// Directional albedo of a GGX lobe that reflects once with a Fresnel term f0 + (1 - f0) weight(cos): linear in f0, so
/// that two integrals serve all f0 of one weight (Karis 2013, "Real Shading in Unreal Engine 4").
struct GgxAlbedo {
    double whole;      ///< with a reflectance of 1 for all angles
    double schlick;    ///< with schlick_weight() for its reflectance
    double dielectric; ///< with a DielectricWeight

    double with_dielectric(double f0) const { return f0 * (whole - dielectric) + dielectric; }
};

/// For light along |cos| from the normal, an isotropic roughness `alpha` (0: smooth, exact), and a DielectricWeight of
/// `root`, all in [0,1]. Interpolated elsewhere, within some 1e-3.
GgxAlbedo ggx_albedo(double cosine, double alpha, double root);

/// Roughness of the isotropic lobe that reflects nearly as much as one of these: within 4 % of a white metal's light.
double mean_alpha(float alpha_x, float alpha_y);

/// Its mean over the hemisphere, weighted by the cosine.
GgxAlbedo mean_ggx_albedo(double alpha, double root);

/// Directional albedo of the lobe f = (1 - cos)^5, cos being that between light and half vector (the sheen of Burley
/// 2012, 5.4, [1/sr]).
double sheen_albedo(double cosine);

} // namespace keyhole
