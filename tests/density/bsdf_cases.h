// The models under test, with directions to look at them from.
#pragma once

#include "scene/bsdf.h"

#include <string>
#include <vector>

namespace keyhole::test {

struct BsdfCase {
    std::string name;
    Bsdf::Model model;
    double index_below = 1;    ///< refractive index below the normal; above it is 1
    bool conserves = false;    ///< white, and nothing is lost: all light comes back
    bool draws_always = false; ///< sample() never fails
    double most_weight = 1.02; ///< bound on eval cos / pdf, radiance scaling left out
};

/// All models, white where they can be.
const std::vector<BsdfCase>& bsdf_cases();

/// Unit directions above and below, steep and grazing.
const std::vector<Vec3>& looks();

/// The case's model in the frame of the coordinate axes.
inline Bsdf bsdf_of(const BsdfCase& c) { return {Frame(), c.model}; }

inline double index_on_side(const BsdfCase& c, const Vec3& w) { return w.z < 0 ? c.index_below : 1.0; }

} // namespace keyhole::test
