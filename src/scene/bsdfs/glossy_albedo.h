// How much light the lobes of layered models reflect in all: what the layers below them may have.
#pragma once

namespace keyhole {

/// Directional albedo of a GGX lobe that reflects once, split by Schlick's Fresnel term f0 + (f90 - f0) (1 - cos)^5:
/// linear in both reflectances, so that one table serves all (Karis 2013, "Real Shading in Unreal Engine 4").
struct SplitAlbedo {
    double whole; ///< with a reflectance of 1 for all angles
    double edge;  ///< with the weight (1 - cos)^5

    double operator()(double f0, double f90) const { return f0 * (whole - edge) + f90 * edge; }
};

/// Schlick's weight (1 - cos)^5 of grazing light (Schlick 1994, equation 15).
inline double schlick_weight(double cosine) {
    const double x = 1 - cosine, x2 = x * x;
    return x2 * x2 * x;
}

/// For light along |cos| from the normal and an isotropic roughness `alpha`, both in [0,1]; 0: smooth, exact.
/// Interpolated elsewhere, within some 1e-3.
SplitAlbedo ggx_albedo(double cosine, double alpha);

/// Its mean over the hemisphere, weighted by the cosine.
SplitAlbedo mean_ggx_albedo(double alpha);

/// Directional albedo of the lobe f = (1 - cos)^5, cos being that between light and half vector (the sheen of Burley
/// 2012, 5.4, [1/sr]).
double sheen_albedo(double cosine);

} // namespace keyhole
