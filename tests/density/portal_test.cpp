// Directions through openings against the density they claim.
#include "sampling/portal.h"
#include "support/chi_squared.h"

#include <gtest/gtest.h>

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
