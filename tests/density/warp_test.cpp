// Maps from the unit square, and the rays of camera and area lights, against the densities they claim.
#include "scene/camera.h"
#include "scene/emitters/emitters.h"
#include "scene/geometry.h"
#include "scene/shape.h"
#include "scene/warp.h"
#include "support/chi_squared.h"

#include <gtest/gtest.h>

namespace keyhole::test {
namespace {

constexpr int kTests = 14;

void expect_directions(const DirectionSampler& sample, const DirectionDensity& density, std::uint64_t stream,
                       const Frame& frame = {}) {
    SphereTest cells;
    cells.frame = frame;
    EXPECT_GT(direction_histogram(sample, density, stream, cells).p_value(), sidak_threshold(kTests));
}

TEST(Warp_Directions, FollowTheirDensities) {
    const auto with = [](Vec3 (*warp)(double, double)) {
        return [warp](SampleSource& s) -> std::optional<Vec3> {
            const double u0 = s.next(), u1 = s.next();
            return warp(u0, u1);
        };
    };
    expect_directions(
        with(cosine_hemisphere), [](const Vec3& w) { return std::max(0.0f, w.z) * kInvPi; }, 0);
    expect_directions(
        with(uniform_sphere), [](const Vec3&) { return kInvPi / 4; }, 1);
    constexpr double kCosine = 0.5; // ends a row of cells
    expect_directions(
        [](SampleSource& s) -> std::optional<Vec3> {
            const double u0 = s.next(), u1 = s.next();
            return uniform_cone(u0, u1, kCosine);
        },
        [](const Vec3& w) { return w.z >= kCosine ? 1 / (2 * kPi * (1 - kCosine)) : 0.0; }, 2);
}

/// Counts of points over a grid of n x n cells of the unit square.
void expect_uniform(const std::function<Vec2(double, double)>& to_square, std::uint64_t stream) {
    constexpr int n = 12, kSamples = 100'000;
    Histogram h{std::vector<double>(n * n), std::vector<double>(n * n, kSamples / double{n * n})};
    Rng rng(1, StreamPurpose::test, stream);
    for (int i = 0; i < kSamples; ++i) {
        const double u0 = rng.next(), u1 = rng.next();
        const Vec2 p = to_square(u0, u1);
        const auto cell = [](float x) {
            return static_cast<std::size_t>(std::clamp(static_cast<int>(x * n), 0, n - 1));
        };
        h.observed[cell(p.x) * n + cell(p.y)] += 1;
    }
    EXPECT_GT(h.p_value(), sidak_threshold(kTests));
}

TEST(Warp_Areas, AreUniform) {
    // Radius squared and angle are uniform where area is.
    expect_uniform(
        [](double u0, double u1) {
            const Vec2 p = uniform_disc(u0, u1);
            const double turn = std::atan2(p.y, p.x) / (2 * kPi);
            return Vec2(p.length2(), static_cast<float>(turn < 0 ? turn + 1 : turn));
        },
        3);
    // Share of the first corner within the rest: each triangle cut off has the square of its side as area.
    expect_uniform(
        [](double u0, double u1) {
            const Vec2 b = uniform_triangle(u0, u1);
            const float s = b.x + b.y;
            return Vec2(s * s, s > 0 ? b.y / s : 0);
        },
        4);
}

TEST(Camera_Rays, FollowTheirDensity) {
    for (const int height : {100, 40}) {
        CameraParameters parameters;
        parameters.fov_degrees = 75;
        const Camera camera(parameters, {.width = 100, .height = height, .margin = 2});
        const SurfacePoint eye = camera.eye(0.5, 0.5);
        const auto sample = [&](SampleSource& s) -> std::optional<Vec3> {
            const auto x = static_cast<float>(s.next()), y = static_cast<float>(s.next());
            return camera.ray_direction(eye, {x, y});
        };
        const auto density = [&](const Vec3& w) { return camera.image_point(eye, w) ? camera.direction_pdf(w) : 0.0; };
        expect_directions(sample, density, 5 + static_cast<std::uint64_t>(height), Frame(Vec3(0, 0, -1)));
    }
}

Shape area_light(Geometry geometry, bool two_sided) {
    Shape shape;
    shape.geometry = std::move(geometry);
    shape.material = make_black();
    shape.emission = std::make_unique<SurfaceEmission>(SurfaceEmission{Rgb(1.0), two_sided});
    return shape;
}

TriangleMesh two_triangles() {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}, {0, 1, 2}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
    return mesh;
}

TEST(AreaEmitter_Directions, FollowTheirDensity) {
    for (const bool two_sided : {false, true}) {
        const Shape shape = area_light(two_triangles(), two_sided);
        const auto emitter = make_area_emitter(shape, 0);
        Rng rng(2, StreamPurpose::test, 0);
        const SurfacePoint point = emitter->sample_point(rng).point;
        const auto sample = [&](SampleSource& s) -> std::optional<Vec3> { return emitter->sample_ray(point, s).w; };
        expect_directions(
            sample, [&](const Vec3& w) { return emitter->ray_pdf(point, w); }, two_sided ? 9 : 10, Frame(point.ng));
    }
}

TEST(AreaEmitter_Directions, FollowTheirProfile) {
    for (const EmissionProfile& profile : {EmissionProfile::grid(110), EmissionProfile::cone(20, 70)}) {
        Shape shape = area_light(two_triangles(), false);
        shape.emission->profile = profile;
        const auto emitter = make_area_emitter(shape, 0);
        Rng rng(2, StreamPurpose::test, 0);
        const SurfacePoint point = emitter->sample_point(rng).point;
        expect_directions([&](SampleSource& s) -> std::optional<Vec3> { return emitter->sample_ray(point, s).w; },
                          [&](const Vec3& w) { return emitter->ray_pdf(point, w); }, 12, Frame(point.ng));
        // Proportional to what is emitted: every light path starts with the same power.
        for (int i = 0; i < 100; ++i) {
            const EmitterRay ray = emitter->sample_ray(point, rng);
            EXPECT_NEAR(luminance(emitter->radiance(point, ray.w)) * point.abs_cos(ray.w) / ray.pdf,
                        emitter->power() / surface_area(shape), 1e-3 * emitter->power());
        }
    }
}

TEST(AreaEmitter_Points, AreUniformByArea) {
    const Shape ball = area_light(Sphere{Vec3(1, 2, 3), 2}, false), mesh = area_light(two_triangles(), false);
    const auto sphere = make_area_emitter(ball, 0), triangles = make_area_emitter(mesh, 0);
    expect_directions(
        [&](SampleSource& s) -> std::optional<Vec3> { return (sphere->sample_point(s).point.p - Vec3(1, 2, 3)) / 2; },
        [&](const Vec3&) { return sphere->point_pdf({}) * 4; }, 11);
    Rng rng(3, StreamPurpose::test, 0);
    constexpr int kSamples = 50'000;
    Histogram h{{0, 0}, {kSamples * 1.5 / 2.5, kSamples * 1.0 / 2.5}}; // their areas
    for (int i = 0; i < kSamples; ++i) {
        const auto [point, pdf] = triangles->sample_point(rng);
        EXPECT_NEAR(pdf, 1 / 2.5, 1e-6);
        h.observed[point.primitive] += 1;
    }
    EXPECT_GT(h.p_value(), sidak_threshold(kTests));
}

TEST(CirclePoint, IsCosineAndSine) {
    for (int i = 0; i <= 4000; ++i) {
        const double turns = i / 4000.0;
        const auto [x, y] = circle_point(turns);
        EXPECT_NEAR(x, std::cos(2 * kPi * turns), 1e-11);
        EXPECT_NEAR(y, std::sin(2 * kPi * turns), 1e-11);
    }
}

} // namespace
} // namespace keyhole::test
