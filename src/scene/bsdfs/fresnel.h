// Reflectance of smooth boundaries for unpolarised light.
#pragma once

#include "scene/scattering.h"

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

} // namespace keyhole
