// Small places from which few of many rays bring most of what makes rays differ.
#pragma once

#include "core/vec.h"

#include <span>
#include <vector>

namespace keyhole {

/// What a gather ray found where it ended.
struct RadianceSample {
    Vec3 place;
    float distance;  ///< of the ray's origin [m]; 0: not known
    double radiance; ///< that it brings, as luminance [W/(m^2 sr)]
};

struct BrightBall {
    Vec3 centre;
    float radius; ///< [m]
    double share; ///< of the second moment of what all rays bring
};

struct BrightBalls {
    std::vector<BrightBall> balls; ///< that of the largest share first
    /// Of the second moment of what rays bring, what is left where some of them are drawn in the directions that each
    /// ball fills and some everywhere, as many as is best.
    double left = 1;
};

/// Balls that are worth rays of their own. Bright samples are divided in two again and again, and balls for the parts
/// kept where they promise less variance than one for the whole. A ball leaves out what lies alone; the margin around
/// the samples in it is wider the fewer these are.
BrightBalls find_bright_balls(std::span<const RadianceSample> samples);

} // namespace keyhole
