// Lobes where gather rays end: wide enough for rays to find what is reflected in them, and as bright as narrow ones.
#pragma once

#include "scene/bsdf.h"

namespace keyhole {

/// A BSDF that stands for one with narrower lobes: path space regularisation (Kaplanyan and Dachsbacher 2013).
struct WideLobe {
    Bsdf bsdf;
    double scale; ///< of its value, so that it reflects as much of even light as the narrow one
};

/// `part` with no lobe narrower than `least_alpha`, seen along `back`. At grazing angles a coat of roughness 0.05
/// reflects twice what one of 0.2 does.
inline WideLobe wide_lobe(const Bsdf& part, double least_alpha, const Vec3& back) {
    const Bsdf wide = part.widened(least_alpha);
    const double albedo = wide.glossy_albedo(back);
    return {wide, albedo > 0 ? part.glossy_albedo(back) / albedo : 1};
}

} // namespace keyhole
