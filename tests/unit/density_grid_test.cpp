// Densities on a grid: what is between values, and exact integrals along rays.
#include "scene/media/density_grid.h"

#include "core/error.h"
#include "core/rng.h"
#include "scene/warp.h"

#include <gtest/gtest.h>

#include <limits>

namespace keyhole {
namespace {

const Imath::Box3d kBox(Imath::V3d(-1, 0, 2), Imath::V3d(2, 1, 4));

DensityGrid::Values random_values(const std::array<int, 3>& size) {
    Rng rng(3, StreamPurpose::test, 0);
    DensityGrid::Values values{size, {}};
    for (int i = 0; i < size[0] * size[1] * size[2]; ++i) values.density.push_back(static_cast<float>(rng.next()));
    return values;
}

Imath::M44d turned() {
    Imath::M44d m;
    m.rotate(Imath::V3d(0.3, -0.7, 1.1));
    m.scale(Imath::V3d(1.5, 0.8, 1));
    m[3][0] = 0.5;
    return m;
}

/// By the trapezoidal rule, with so many steps.
double by_steps(const DensityGrid& grid, const Vec3& o, const Vec3& w, double t0, double t1, int steps) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += grid.density(o + w * static_cast<float>(t0 + (t1 - t0) * (i + 0.5) / steps));
    return sum * (t1 - t0) / steps;
}

TEST(DensityGrid, IsTrilinearBetweenTheMiddlesOfCells) {
    DensityGrid::Values values{{2, 1, 1}, {1, 3}};
    const DensityGrid grid(values, Imath::Box3d(Imath::V3d(0.0), Imath::V3d(2, 1, 1)), {});
    EXPECT_NEAR(grid.density({0.5f, 0.5f, 0.5f}), 1, 1e-6);
    EXPECT_NEAR(grid.density({1, 0.5f, 0.5f}), 2, 1e-6);
    EXPECT_NEAR(grid.density({1.5f, 0.5f, 0.5f}), 3, 1e-6);
    EXPECT_NEAR(grid.density({1.75f, 0.5f, 0.5f}), 2.25, 1e-6) << "beyond the faces there is nothing";
    EXPECT_NEAR(grid.density({1.5f, 0.75f, 0.5f}), 2.25, 1e-6);
    EXPECT_EQ(grid.density({2.01f, 0.5f, 0.5f}), 0);
    EXPECT_EQ(grid.density({-0.01f, 0.5f, 0.5f}), 0);
}

TEST(DensityGrid, ItsIntegralsAreThoseOfItsDensity) {
    const DensityGrid grid(random_values({5, 3, 4}), kBox, turned());
    Rng rng(1, StreamPurpose::test, 1);
    int through = 0;
    for (int i = 0; i < 200; ++i) {
        const Vec3 middle(0.9f, -0.6f, 3.2f), w = uniform_sphere(rng.next(), rng.next());
        const Vec3 o = middle + uniform_sphere(rng.next(), rng.next()) * static_cast<float>(3 * rng.next());
        const double t0 = rng.next(), t1 = t0 + 6 * rng.next(), expected = by_steps(grid, o, w, t0, t1, 20'000);
        EXPECT_NEAR(grid.integral(o, w, t0, t1), expected, 2e-4);
        through += expected > 0.1 ? 1 : 0;
        const double whole = grid.integral(o, w, 0, std::numeric_limits<double>::infinity());
        EXPECT_NEAR(whole, grid.integral(o, w, 0, 20), 1e-9);
    }
    EXPECT_GT(through, 50);
}

TEST(DensityGrid, AlongAnAxisToo) {
    const DensityGrid grid(random_values({5, 3, 4}), kBox, {});
    for (const float side : {-1.0f, 1.0f})
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 o(0.3f, 0.4f, 2.9f), w(0, 0, 0);
            w[axis] = side;
            o[axis] -= 7 * side;
            EXPECT_NEAR(grid.integral(o, w, 0, 20), by_steps(grid, o, w, 0, 20, 200'000), 2e-4);
        }
}

TEST(DensityGrid, ReachesWhatItsIntegralSays) {
    const DensityGrid grid(random_values({5, 3, 4}), kBox, turned());
    Rng rng(1, StreamPurpose::test, 2);
    int reached = 0;
    for (int i = 0; i < 400; ++i) {
        const Vec3 o(0.9f, -0.6f, 3.2f), w = uniform_sphere(rng.next(), rng.next());
        const double t0 = 0.3 * rng.next(), t1 = t0 + 3 * rng.next(), amount = rng.next();
        const auto t = grid.reach(o, w, t0, t1, amount);
        const double whole = grid.integral(o, w, t0, t1);
        ASSERT_EQ(t.has_value(), whole >= amount);
        if (!t) continue;
        ++reached;
        EXPECT_NEAR(grid.integral(o, w, t0, *t), amount, 1e-9);
    }
    EXPECT_GT(reached, 50);
    EXPECT_LT(reached, 350);
}

TEST(DensityGrid, HasAVolume) {
    EXPECT_THROW(DensityGrid(random_values({2, 2, 2}), Imath::Box3d(Imath::V3d(0.0), Imath::V3d(1, 0, 1)), {}),
                 InputError);
    DensityGrid::Values few{{2, 2, 2}, {1}};
    EXPECT_THROW(DensityGrid(few, kBox, {}), InputError);
    Imath::M44d flat;
    flat[1][1] = 0;
    EXPECT_THROW(DensityGrid(random_values({1, 1, 1}), kBox, flat), InputError);
    Imath::M44d far;
    far[3][0] = 1e14;
    EXPECT_THROW(DensityGrid(random_values({1, 1, 1}), kBox, far), InputError);
    for (const double huge : {1e200, 1e300})
        EXPECT_THROW(DensityGrid(random_values({1, 1, 1}), Imath::Box3d(Imath::V3d(0.0), Imath::V3d(huge)), {}),
                     InputError);
}

} // namespace
} // namespace keyhole
