// Direct light at the precomputation points of an irradiance map.
#pragma once

#include "gather/direct_light.h"

namespace keyhole {

struct DirectIrradiance {
    Rgb irradiance{0.0}; ///< [W/m^2]
    float reach = 0;     ///< how far away it may stand in for a place's own [m]; infinite where only the sky shines
};

/// Irradiance that emitters bring to a surface on the side of unit normal `n`, by so many samples of either technique.
/// Directions have the weights that the diffuse part of `bsdf` gives them (Bsdf::diffuse_weight()).
/// Towards an emitter it changes with the distance, squared, and so it may be used within a quarter of that only.
DirectIrradiance direct_irradiance(const Scene& scene, const SurfacePoint& point, const Bsdf& bsdf, const Vec3& n,
                                   const LightSamples& samples, SampleSource& source);

} // namespace keyhole
