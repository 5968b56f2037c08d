// The stratified hemisphere and its gradients, against closed forms and finite differences.
#include "gather/hemisphere.h"

#include "core/rng.h"
#include "core/statistics.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

namespace keyhole {
namespace {

using Imath::V3d;
constexpr float kNothing = std::numeric_limits<float>::infinity();

/// What a ray from a point along a direction brings.
using Field = std::function<HemisphereRay(const Vec3& p, const Vec3& w)>;

/// One hemisphere of about `rays` rays.
HemisphereEstimate look(const Field& field, const Vec3& p, const Vec3& normal, int rays, std::uint64_t index) {
    Rng rng(1, StreamPurpose::test, index);
    const HemisphereGrid grid(rays);
    const Frame frame(normal);
    std::vector<HemisphereRay> found;
    for (int i = 0; i < grid.size(); ++i) {
        const double u0 = rng.next(), u1 = rng.next();
        found.push_back(field(p, frame.to_world(grid.direction(i, u0, u1))));
    }
    return grid.estimate(found, frame);
}

/// A rectangle of radiance 1 at height 1 above the plane z = 0, before darkness.
struct Rectangle {
    Vec3 lo, hi;

    HemisphereRay operator()(const Vec3& p, const Vec3& w) const {
        const float t = (lo.z - p.z) / w.z;
        const Vec3 q = p + w * t;
        const bool hit = t > 0 && q.x > lo.x && q.x < hi.x && q.y > lo.y && q.y < hi.y;
        return hit ? HemisphereRay{Rgb(1.0), t} : HemisphereRay{Rgb(0.0), kNothing};
    }
    /// Lambert's formula for polygons (all of it above the horizon).
    double irradiance(const V3d& p, const V3d& n) const {
        const std::array<V3d, 4> c{V3d(lo.x, lo.y, lo.z), V3d(hi.x, lo.y, lo.z), V3d(hi.x, hi.y, lo.z),
                                   V3d(lo.x, hi.y, lo.z)};
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const V3d a = (c[i] - p).normalized(), b = (c[(i + 1) % 4] - p).normalized();
            sum += std::acos(a.dot(b)) * a.cross(b).normalized().dot(n);
        }
        return std::abs(sum) / 2;
    }
};

TEST(Hemisphere, OfUniformLightHasNoGradients) {
    const auto e = look(
        [](const Vec3&, const Vec3& w) {
            return HemisphereRay{Rgb(2.0, 1.0, 0.5), 1 + w.z};
        },
        {0, 0, 0}, Vec3(1, 2, 3).normalized(), 200, 0);
    EXPECT_NEAR(e.irradiance.x, 2 * kPi, 1e-9);
    EXPECT_NEAR(e.irradiance.z, 0.5 * kPi, 1e-9);
    for (const Vec3& g : e.rotation) EXPECT_LT(g.length(), 1e-5f);
    for (const Vec3& g : e.translation) EXPECT_LT(g.length(), 1e-6f);
}

TEST(Hemisphere, TellsItsVariance) {
    Rng light(2, StreamPurpose::test, 0);
    const auto spread_told = [](const Field& field) {
        RunningStats found, told;
        for (std::uint64_t i = 0; i < 400; ++i) {
            const auto e = look(field, {0, 0, 0}, {0, 0, 1}, 300, i);
            found.add(e.irradiance.x);
            told.add(e.variance);
        }
        return told.mean() / found.variance();
    };
    const Rectangle lamp{{-0.4f, 0.1f, 1}, {0.3f, 0.8f, 1}};
    EXPECT_NEAR(spread_told([&](const Vec3&, const Vec3&) {
                    return HemisphereRay{Rgb(light.next()), 1};
                }),
                1, 0.2)
        << "light without any pattern";
    const double ratio = spread_told(lamp);
    EXPECT_GT(ratio, 0.9) << "never more certain than it is";
    EXPECT_LT(ratio, 4) << "borders of cells and lamps fall together only in part";
}

TEST(Hemisphere, RotationGradientOfHalfASkyIsExact) {
    // Bright for x > 0: E(n) = pi/2 (1 + n.x), so that the derivative is (pi/2, 0, 0).
    const auto e = look(
        [](const Vec3&, const Vec3& w) {
            return HemisphereRay{Rgb(w.x > 0 ? 1.0 : 0.0), kNothing};
        },
        {0, 0, 0}, {0, 0, 1}, 20'000, 0);
    EXPECT_NEAR(e.irradiance.x, kPi / 2, 0.01);
    EXPECT_NEAR(e.rotation[0].x, kPi / 2, 0.02);
    EXPECT_NEAR(e.rotation[0].y, 0, 0.02);
    EXPECT_EQ(e.translation[0].length(), 0);
    EXPECT_TRUE(std::isinf(e.distance));
}

TEST(Hemisphere, GradientsUnderARectangleMatchLambertsFormula) {
    const Rectangle rectangle{{0.2f, -0.5f, 1}, {1.4f, 0.9f, 1}};
    const double h = 1e-4;
    const auto slope = [&](const V3d& dp, const V3d& dn) {
        const V3d n(0, 0, 1);
        return (rectangle.irradiance(dp * h, n + dn * h) - rectangle.irradiance(dp * -h, n - dn * h)) / (2 * h);
    };
    Rgb irradiance(0.0);
    Vec3 rotation(0.0f), translation(0.0f);
    constexpr int kRuns = 40;
    for (int i = 0; i < kRuns; ++i) {
        const auto e = look(rectangle, {0, 0, 0}, {0, 0, 1}, 3000, static_cast<std::uint64_t>(i));
        irradiance += e.irradiance / kRuns;
        rotation += e.rotation[0] / kRuns;
        translation += e.translation[0] / kRuns;
    }
    const V3d zero(0, 0, 0), x(1, 0, 0), y(0, 1, 0);
    EXPECT_NEAR(irradiance.x, rectangle.irradiance(zero, {0, 0, 1}), 2e-3);
    EXPECT_NEAR(rotation.x, slope(zero, x), 0.01);
    EXPECT_NEAR(rotation.y, slope(zero, y), 0.01);
    EXPECT_NEAR(translation.x, slope(x, zero), 0.03 * std::abs(slope(x, zero)));
    EXPECT_NEAR(translation.y, slope(y, zero), 0.03 * std::abs(slope(x, zero)));
    EXPECT_GT(std::abs(slope(y, zero)), 0.05 * std::abs(slope(x, zero))) << "else nothing would be tested along y";
}

TEST(Hemisphere, GradientsInARoomMatchFiniteDifferences) {
    // Inside the box [-1, 2] x [-1, 1] x [0, 1.5] whose walls glow unevenly.
    const Field room = [](const Vec3& p, const Vec3& w) {
        const Vec3 lo(-1, -1, 0), hi(2, 1, 1.5f);
        float t = kNothing;
        for (int k = 0; k < 3; ++k)
            if (w[k] != 0) t = std::min(t, ((w[k] > 0 ? hi : lo)[k] - p[k]) / w[k]);
        const Vec3 q = p + w * t;
        return HemisphereRay{Rgb(1 + 0.5 * std::sin(2.0 * q.x + q.z), 1.0 + q.y * q.z, 0.5), t};
    };
    const Vec3 p(0.4f, 0.3f, 0.0f), n(0, 0, 1);
    const auto mean = [&](const Vec3& at, const Vec3& normal) { return look(room, at, normal, 400'000, 7).irradiance; };
    const auto e = look(room, p, n, 100'000, 3);
    const float h = 0.02f;
    for (int axis = 0; axis < 2; ++axis) {
        Vec3 step(0.0f);
        step[axis] = h;
        const Rgb moved = (mean(p + step, n) - mean(p - step, n)) / (2.0 * h);
        const Rgb turned = (mean(p + Vec3(0, 0, 1e-3f), (n + step).normalized()) -
                            mean(p + Vec3(0, 0, 1e-3f), (n - step).normalized())) /
                           (2.0 * h);
        for (int c = 0; c < 2; ++c) {
            EXPECT_NEAR(e.translation[static_cast<std::size_t>(c)][axis], moved[c], 0.04) << axis << c;
            EXPECT_NEAR(e.rotation[static_cast<std::size_t>(c)][axis], turned[c], 0.06) << axis << c;
        }
    }
}

} // namespace
} // namespace keyhole
