// Reflectance of smooth boundaries for unpolarised light.
#pragma once

#include "scene/scattering.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

/// Fresnel reflectance at a smooth dielectric boundary, and the cosine of refraction.
struct FresnelResult {
    double reflectance; ///< 1 under total internal reflection
    double cos_t;       ///< |cos| on the far side; 0 under total internal reflection
};

/// `cos_i` > 0 on the near side; `eta` is the far refractive index over the near one.
FresnelResult fresnel_dielectric(double cos_i, double eta);

/// Complex refractive indices of a metal over that of the medium outside, for the three primaries.
struct ComplexIndex {
    StoredRgb eta{Rgb(1.0)}, k{Rgb(0.0)};
};

/// Fresnel reflectance of a metal; `cos_i` >= 0 outside. Born and Wolf, Principles of Optics, 14.2.
Rgb fresnel_conductor(double cos_i, const ComplexIndex& index);

// How a reflectance rises from that along the normal, f0, to 1 along the surface: F = f0 + (1 - f0) weight(cos).

/// Schlick's weight (1 - cos)^5 of grazing light (Schlick 1994, equation 15): near that of metals.
inline double schlick_weight(double cosine) {
    const double x = 1 - cosine, x2 = x * x;
    return x2 * x2 * x;
}

/// The weight by Fresnel's equations for a dielectric, (F(cos) - f0) / (1 - f0). By Schlick's one of index 1.5 would
/// reflect 23 % too little at 55 degrees. For f0 of 0 there is no reflection at any angle.
class DielectricWeight {
  public:
    /// Of the index 3. The weight of larger ones, which nothing clear has, is taken to be that of 3: from 3.7 on it
    /// would fall before it rises.
    static constexpr double kMostRoot = 0.5;

    /// `root` is that of f0, in [0,1]: (eta - 1) / (eta + 1) of the index eta.
    explicit DielectricWeight(double root) : root_(std::min(root, kMostRoot)), eta_((1 + root_) / (1 - root_)) {}

    double operator()(double cosine) const {
        if (root_ == 0) return 0;
        const double f0 = root_ * root_;
        return std::max(0.0, (fresnel_dielectric(cosine, eta_).reflectance - f0) / (1 - f0));
    }

  private:
    double root_, eta_;
};

} // namespace keyhole
