// What light did before it reached the eye.
#pragma once

#include "sampling/path.h"

namespace keyhole {

/// Kinds of paths by the vertices that are not specular.
enum class LightClass {
    emission, ///< L S* E
    direct,   ///< L D S* E
    caustic,  ///< L S+ D S* E
    second,   ///< L D S* D S* E: direct light at the second D seen
    indirect, ///< everything else with two or more D
};

inline LightClass light_class(const Path& path) {
    if (const int d2 = nth_finite_from_eye(path, 2); d2 > 0) return d2 > 1 ? LightClass::indirect : LightClass::second;
    const int d1 = nth_finite_from_eye(path, 1);
    return d1 == 0 ? LightClass::emission : d1 == 1 ? LightClass::direct : LightClass::caustic;
}

/// Whether a path of class `light` that ends in x1, x0 is in the set.
inline bool in_set(LightClass light, const PathSet& set, const SurfacePoint& x1, const SurfacePoint& x0) {
    if (set.everything || light == LightClass::caustic || light == LightClass::indirect) return true;
    return light == LightClass::second && !set.reaches(x1, x0);
}

} // namespace keyhole
