// Directions through openings against the density they claim.
#include "sampling/guidance/user_paths.h"
#include "support/chi_squared.h"

#include <gtest/gtest.h>

#include <optional>

namespace keyhole::test {
namespace {

struct Parallelogram {
    Imath::V3d corner, u, v;
};

/// Counts over cells of the opening, and what the density per solid angle makes of each.
Histogram histogram(const Parallelogram& shape, const Vec3& from, std::uint64_t stream) {
    constexpr int n = 12, kSamples = 100'000;
    const Portal portal(shape.corner, shape.u, shape.v);
    const Imath::V3d normal = shape.u.cross(shape.v), origin(from);
    Histogram h{std::vector<double>(n * n), {}};
    Rng rng(1, StreamPurpose::test, stream);
    for (int i = 0; i < kSamples; ++i) {
        const Imath::V3d w(portal.sample(from, rng));
        const Imath::V3d p = origin + w * ((shape.corner - origin).dot(normal) / w.dot(normal)) - shape.corner;
        const double a = p.cross(shape.v).dot(normal) / normal.length2();
        const double b = shape.u.cross(p).dot(normal) / normal.length2();
        const auto cell = [](double x) {
            return static_cast<std::size_t>(std::clamp(static_cast<int>(x * n), 0, n - 1));
        };
        EXPECT_TRUE(a > -1e-3 && a < 1.001 && b > -1e-3 && b < 1.001) << a << ' ' << b;
        h.observed[cell(a) * n + cell(b)] += 1;
    }
    const auto per_cell = [&](double a, double b) {
        const Imath::V3d d = shape.corner + shape.u * a + shape.v * b - origin;
        return portal.density(from, Vec3(d.normalized())) * std::abs(normal.dot(d)) / std::pow(d.length(), 3);
    };
    constexpr double inside = 1e-6; // rounding would miss the border
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
            h.expected.push_back(kSamples * integrate(per_cell, std::max(inside, i / double{n}),
                                                      std::min(1 - inside, (i + 1) / double{n}),
                                                      std::max(inside, k / double{n}),
                                                      std::min(1 - inside, (k + 1) / double{n})));
    return h;
}

TEST(Portal, DirectionsFollowTheirDensity) {
    const Parallelogram window{{-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0}}, slit{{0, 0, 0}, {0, 2.4, 0}, {0, 0, 0.003}},
        askew{{0.2, 0, -1}, {0.3, 0.8, 0.1}, {0.5, -0.2, 0.7}};
    std::uint64_t stream = 70;
    for (const auto& [shape, from] : std::initializer_list<std::pair<Parallelogram, Vec3>>{
             {window, {0.2f, 0.1f, 2}},
             {window, {0.4f, -0.6f, -0.05f}}, // close to an edge, from behind
             {slit, {-2, 0, 0.4f}},
             {slit, {-0.02f, 0, -0.01f}}, // beside its end
             {askew, {0, 0, 0.5f}},
             {askew, {1.5f, 2, -1}}}) {
        const Histogram h = histogram(shape, from, stream++);
        double total = 0;
        for (const double e : h.expected) total += e;
        EXPECT_NEAR(total, 100'000, 200) << "stream " << stream - 1;
        EXPECT_GT(h.p_value(), sidak_threshold(6)) << "stream " << stream - 1;
    }
}

/// Where lines through a slit meet walls on both sides of it: counts over cells of either, against the density of the
/// pair integrated over the other.
TEST(Portal, LinesFollowTheirDensity) {
    const Portal slit({0, 0, 0}, {0, 2, 0}, {0, 0.4, 0.3}); // a parallelogram in the plane x = 0
    constexpr int n = 6, kSamples = 200'000, kInner = 10;
    constexpr double kHalf = 4; // of the walls x = -1 and x = 1, which most lines meet
    const Vec3 side(-0.5f, 3, 1);
    Histogram h{std::vector<double>(n * n), {}};
    const auto cell = [](double y, double z) -> std::optional<std::size_t> {
        const double a = (y + kHalf) / (2 * kHalf), b = (z + kHalf) / (2 * kHalf);
        if (!(a >= 0 && a < 1 && b >= 0 && b < 1)) return std::nullopt;
        return static_cast<std::size_t>(a * n) * n + static_cast<std::size_t>(b * n);
    };
    Rng rng(1, StreamPurpose::test, 90);
    for (int i = 0; i < kSamples; ++i) {
        const Portal::Line line = slit.sample_line(side, rng);
        EXPECT_GT(line.w.x, 0);
        const auto at = [&](float x) { return line.p + line.w * (x / line.w.x); };
        const auto near = cell(at(-1).y, at(-1).z), far = cell(at(1).y, at(1).z);
        EXPECT_GT(slit.line_density(side, at(-1), at(1)), 0) << i;
        if (near && far) h.observed[*near] += 1;
    }
    // Of the near end, the far one anywhere: integrated over the opening, through which the far wall is seen.
    const auto density = [&](double y, double z) {
        const Imath::V3d b(-1, y, z);
        double sum = 0;
        for (int i = 0; i < kInner; ++i)
            for (int k = 0; k < kInner; ++k) {
                const double u = (i + 0.5) / kInner, v = (k + 0.5) / kInner;
                const Imath::V3d p(0, 2 * u + 0.4 * v, 0.3 * v),
                    c = p * 2 - b; // the far wall is as far as the near one
                if (!cell(c.y, c.z)) continue;
                const double d = (c - b).length(), g = std::pow(2 / d, 2) / (d * d);
                // An area of the opening is four times as large on the far wall, seen from b.
                sum += slit.line_density(side, Vec3(b), Vec3(c)) * g * 4 * 2 * 0.3 / (kInner * kInner);
            }
        return sum;
    };
    const double width = 2 * kHalf / n;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k)
            h.expected.push_back(kSamples * integrate(density, -kHalf + i * width, -kHalf + (i + 1) * width,
                                                      -kHalf + k * width, -kHalf + (k + 1) * width));
    EXPECT_GT(h.p_value(), 1e-3);
}

TEST(Portal, NoLineEndsInItsPlaneOrOnOneSide) {
    const Portal window({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0});
    const Vec3 side(3, 0, 1);
    EXPECT_DOUBLE_EQ(window.line_density(side, {0, 0, 1}, {0, 0, -1}), 1 / kPi);
    EXPECT_EQ(window.line_density(side, {0, 0, -1}, {0, 0, 1}), 0); // the other way
    EXPECT_EQ(window.line_density(side, {0, 0, 1}, {0, 0, 0.5f}), 0);
    EXPECT_EQ(window.line_density(side, {0, 0, 1}, {0, 0, 0}), 0);
    EXPECT_EQ(window.line_density(side, {0, 0, 1}, {3, 0, -1}), 0);
}

TEST(Portal, NothingPassesBesideItOrAwayFromIt) {
    const Portal window({-0.5, -0.5, 0}, {1, 0, 0}, {0, 1, 0});
    EXPECT_GT(window.density({0, 0, 1}, {0, 0, -1}), 0);
    EXPECT_EQ(window.density({0, 0, 1}, {0, 0, 1}), 0);
    EXPECT_EQ(window.density({0.6f, 0, 1}, {0, 0, -1}), 0);
    EXPECT_EQ(window.density({0, -0.6f, 1}, {0, 0, -1}), 0);
    EXPECT_EQ(window.density({2, 0, 0}, {-1, 0, 0}), 0); // from its own plane
}

} // namespace
} // namespace keyhole::test
