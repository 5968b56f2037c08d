// Photons and surfaces of known density, for the tests of the photon map.
#pragma once

#include "core/rng.h"
#include "core/statistics.h"
#include "photonmap/photon.h"
#include "scene/shape.h"
#include "support/chance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace keyhole::photon_test {

inline Rng make_rng(std::uint64_t index) { return {1, StreamPurpose::test, index}; }

/// The mean is right up to chance, and its standard error is below 2 % of it.
inline void expect_mean(const RunningStats& stats, double expected) {
    EXPECT_TRUE(test::has_mean(stats, expected));
    EXPECT_LT(stats.standard_error(), 0.02 * std::abs(expected)) << "too noisy to mean anything";
}

/// A parallelogram; its normal is that of u x v.
struct Rectangle {
    Vec3 corner, u, v;

    Vec3 normal() const { return u.cross(v).normalized(); }
    double area() const { return static_cast<double>(u.cross(v).length()); }
    Vec3 at(double a, double b) const { return corner + u * static_cast<float>(a) + v * static_cast<float>(b); }
};

inline const Rectangle kUnitSquare{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// `n` photons of power 1 thrown uniformly, lit along the normal (from behind if `side` is -1).
inline void throw_photons(const Rectangle& r, int n, Rng& rng, std::vector<Photon>& out, const Rgb& power = Rgb(1.0),
                          float side = 1) {
    for (int i = 0; i < n; ++i) {
        const double a = rng.next(), b = rng.next();
        out.emplace_back(r.at(a, b), r.normal(), r.normal() * side, power);
    }
}

inline std::vector<Photon> throw_photons(const Rectangle& r, int n, Rng& rng) {
    std::vector<Photon> photons;
    throw_photons(r, n, rng, photons);
    return photons;
}

/// The rectangle cut into n x n cells of two triangles each.
inline Shape shape_of(const Rectangle& r, std::uint32_t n = 1) {
    TriangleMesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) mesh.positions.push_back(r.at(i / double(n), j / double(n)));
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            mesh.triangles.push_back({a, b, d});
            mesh.triangles.push_back({a, d, c});
        }
    }
    Shape shape;
    shape.geometry = std::move(mesh);
    return shape;
}

} // namespace keyhole::photon_test
