// Small steps of perturbations: what they are drawn with, and what rounding makes of them.
#include "sampling/proposals/steps.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

constexpr double kLeast = 1e-4, kMost = 0.1;

// Directions and positions are floats, and a step may round to none: the density is the same both ways then, too.
TEST(Steps, OfNoLengthHaveADensity) {
    const Vec3 w = Vec3(1, 2, 3).normalized();
    const double of_directions = DirectionStep(kLeast, kMost).density(w, w);
    const double of_pixels = ImageStep(kLeast, kMost).density({0, 0});
    const double of_beams = BeamStep(kLeast, kMost).density({0, 0, 0}, w, 2);
    for (const double density : {of_directions, of_pixels, of_beams}) {
        EXPECT_GT(density, 0);
        EXPECT_TRUE(std::isfinite(density));
    }
}

// Per unit of area, a share of 1 / (2 pi r^2 log(most / least)) whatever the radius is.
TEST(Steps, HaveTheDensityOfLogUniformRadii) {
    const ImageStep step(kLeast, kMost);
    for (const double r : {2e-4, 1e-3, 0.05})
        EXPECT_NEAR(step.density({static_cast<float>(r), 0}) * 2 * kPi * r * r * std::log(kMost / kLeast), 1, 1e-6);
    EXPECT_EQ(step.density({static_cast<float>(1.1 * kMost), 0}), 0);
}

} // namespace
} // namespace keyhole
