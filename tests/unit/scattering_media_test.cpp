// Media that scatter: phase functions, free flights, and single scattering by its integral.
#include "sampling/paths/path_tracer.h"
#include "scene/emitters/emitters.h"
#include "support/chance.h"
#include "support/chi_squared.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

PhaseBsdf phase(float g) { return {Rgb(0.5, 1, 2), Rgb(2.0), g}; }

TEST(PhaseBsdf, DrawsByItsDensityWhichIsAllOfIt) {
    std::uint64_t stream = 0;
    for (const float g : {-0.6f, -0.0005f, 0.0f, 0.3f, 0.85f}) {
        const PhaseBsdf p = phase(g);
        const Vec3 from = Vec3(0.3f, -0.5f, 0.7f).normalized();
        const auto density = [&](const Vec3& to) { return p.pdf(from, to); };
        EXPECT_NEAR(test::integrate_sphere(density, Frame(from)), 1, 1e-4);
        const auto cosine = [&](const Vec3& to) { return p.pdf(from, to) * -static_cast<double>(from.dot(to)); };
        EXPECT_NEAR(test::integrate_sphere(cosine, Frame(from)), g, 1e-4) << "the mean cosine of the turn";
        const auto sample = [&](SampleSource& source) -> std::optional<Vec3> {
            const auto [u0, u1] = source.take<2>();
            const auto s = p.sample(from, u0, u1, 0);
            EXPECT_TRUE(s.has_value());
            EXPECT_NEAR(s->pdf, density(s->to), 1e-5 * s->pdf);
            return s->to;
        };
        const auto histogram = test::direction_histogram(sample, density, ++stream, {.frame = Frame(from)});
        EXPECT_GT(histogram.p_value(), test::sidak_threshold(5)) << "g " << g;
    }
}

TEST(PhaseBsdf, OfSharpPeaksIsANumber) {
    for (const float g : {-0.9999f, -0.999f, 0.9995f, 0.9999f}) {
        const PhaseBsdf p = phase(g);
        const Vec3 from = Vec3(0.3f, -0.5f, 0.7f).normalized();
        RunningStats reciprocal; // of the density: its mean is the solid angle that samples cover
        for (std::uint64_t i = 0; i < 20'000; ++i) {
            Rng rng(1, StreamPurpose::test, i);
            const auto [u0, u1] = rng.take<2>();
            const auto s = p.sample(from, u0, u1, 0);
            ASSERT_TRUE(s && std::isfinite(s->pdf));
            const double a = std::abs(static_cast<double>(g)), v = g < 0 ? u0 : 1 - u0, q = 1 - a + 2 * a * v,
                         cosine = (1 + a * a - std::pow((1 - a * a) / q, 2)) / (2 * a);
            const double expected = (1 - a * a) / (4 * kPi * std::pow(1 + a * a - 2 * a * cosine, 1.5));
            reciprocal.add(s->pdf / expected);
        }
        EXPECT_NEAR(reciprocal.mean(), 1, 0.02) << "g " << g;
    }
}

/// Remembers how long the directions of a walk are.
struct Lengths : WalkHooks {
    std::vector<Vertex> vertices{};
    float shortest = 1, longest = 1;
    Vertex& place() { return vertices.emplace_back(); }
    bool arrive(const Vertex& v, const WalkRay& ray) {
        shortest = std::min(shortest, ray.w.length());
        longest = std::max(longest, ray.w.length());
        return v.point.site == Site::medium;
    }
};

TEST(Media_Flights, KeepTheirDirectionsUnit) {
    test::SceneMaker m;
    m.cloud({-10, -10, -10}, {10, 10, 10}, std::make_shared<const Medium>(Medium{Rgb(0.0), Rgb(20.0), 0.85f}))
        .rectangle({-99, -99, -99}, {1, 0, 0}, {0, 1, 0}, make_diffuse(Rgb(0.5)));
    const auto scene = m.build();
    std::size_t most = 0;
    for (std::uint64_t i = 0; i < 50; ++i) {
        Rng rng(2, StreamPurpose::test, i);
        SurfacePoint start;
        start.site = Site::point;
        Lengths walk;
        walk.vertices.reserve(128);
        random_walk(*scene, From::eye, {&start, &start, Vec3(0, 0.6f, 0.8f)}, 100, rng, walk);
        EXPECT_NEAR(walk.shortest, 1, 1e-6);
        EXPECT_NEAR(walk.longest, 1, 1e-6);
        most = std::max(most, walk.vertices.size());
    }
    EXPECT_EQ(most, 100u) << "none is lost";
}

std::shared_ptr<const Medium> puff() {
    DensityGrid::Values values{{2, 2, 2}, {1, 0.2f, 0.4f, 2, 0.1f, 3, 0.5f, 1}};
    auto grid = std::make_shared<const DensityGrid>(std::move(values), Imath::Box3d(Imath::V3d(-1.0), Imath::V3d(1.0)),
                                                    Imath::M44d());
    return std::make_shared<const Medium>(Medium{Rgb(0.1, 0.2, 0.3), Rgb(1.2, 0.6, 0.9), 0.4f, std::move(grid)});
}

/// A cloud before a wall, a slab that only absorbs between.
std::unique_ptr<Scene> cloud_before_a_wall(const std::shared_ptr<const Medium>& cloud) {
    test::SceneMaker m;
    m.rectangle({-9, -9, -5}, {18, 0, 0}, {0, 18, 0}, make_diffuse(Rgb(0.5)))
        .cloud({-1, -1, -1}, {1, 1, 1}, cloud)
        .cloud({-2, -2, -3}, {2, 2, -2}, std::make_shared<const Medium>(Medium{Rgb(0.5, 0.4, 0.3)}));
    return m.build();
}

/// The same cloud in fog.
std::unique_ptr<Scene> cloud_in_fog(const std::shared_ptr<const Medium>& cloud) {
    const auto fog = std::make_shared<const Medium>(Medium{Rgb(0.0), Rgb(0.05, 0.1, 0.2)});
    test::SceneMaker m;
    m.rectangle({-9, -9, -5}, {18, 0, 0}, {0, 18, 0}, make_diffuse(Rgb(0.5)))
        .cloud({-1, -1, -1}, {1, 1, 1}, cloud, fog)
        .medium(fog);
    return m.build();
}

TEST(Media_Flights, EndByTheirDensity) {
    constexpr int kFlights = 100'000, kCells = 40;
    const auto even = std::make_shared<const Medium>(Medium{Rgb(0.3, 0.1, 0), Rgb(0.2, 0.7, 1.5)});
    std::vector<std::unique_ptr<Scene>> scenes;
    scenes.push_back(cloud_before_a_wall(puff()));
    scenes.push_back(cloud_before_a_wall(even));
    scenes.push_back(cloud_in_fog(even));
    for (const auto& scene : scenes) {
        SurfacePoint from;
        from.p = {0.3f, -0.2f, 4};
        from.site = Site::point;
        const Vec3 w = Vec3(-0.05f, 0.02f, -1).normalized();
        const SurfacePoint wall = scene->trace(from, w).value();
        const double length = (wall.p - from.p).length();
        test::Histogram histogram{std::vector<double>(kCells + 1), std::vector<double>(kCells + 1)};
        for (int i = 0; i < kFlights; ++i) {
            Rng rng(1, StreamPurpose::test, static_cast<std::uint64_t>(i));
            Flight flight(rng.next());
            const FreeFlight flown = scene->fly(from, w, &wall, flight.primary, rng.next());
            const double t = flown.collision ? (flown.collision->p - from.p).length() / length : 1;
            SurfacePoint end = from;
            end.p = flown.collision ? flown.collision->p : wall.p;
            const Attenuation expected = scene->attenuation(from, end);
            for (int k = 0; k < 3 && i < 2000; ++k) {
                EXPECT_NEAR(flown.attenuation.transmittance[k], expected.transmittance[k], 1e-5);
                EXPECT_NEAR(flown.attenuation.uncollided[k], expected.uncollided[k], 1e-5);
            }
            ++histogram.observed[static_cast<std::size_t>(t * kCells)];
        }
        const auto through = [&](double t) {
            SurfacePoint to = from;
            to.p = from.p + w * static_cast<float>(t * length);
            const Rgb left = scene->attenuation(from, to).uncollided;
            return (left.x + left.y + left.z) / 3;
        };
        for (int i = 0; i < kCells; ++i)
            histogram.expected[static_cast<std::size_t>(i)] =
                kFlights * (through(static_cast<double>(i) / kCells) - through((i + 1.0) / kCells));
        histogram.expected[kCells] = kFlights * through(1);
        EXPECT_GT(histogram.p_value(), test::sidak_threshold(3));
        EXPECT_LT(histogram.expected[kCells], 0.6 * kFlights) << "most collide";
    }
}

TEST(Media_Attenuation, CountsWhatOnlyAbsorbsApart) {
    const auto scene = cloud_before_a_wall(std::make_shared<const Medium>(Medium{Rgb(0.5), Rgb(1, 2, 0)}));
    SurfacePoint a, b;
    a.site = b.site = Site::point;
    a.p = {0, 0, 4};
    b.p = {0, 0, -4};
    const Attenuation attenuation = scene->attenuation(a, b);
    EXPECT_NEAR(attenuation.uncollided.x, std::exp(-2 * 1.5), 1e-6);
    EXPECT_NEAR(attenuation.uncollided.z, std::exp(-2 * 0.5), 1e-6);
    EXPECT_NEAR(attenuation.transmittance.x, std::exp(-2 * 1.5 - 0.5), 1e-6);
    EXPECT_TRUE(scene->has_scattering_media());
    EXPECT_FALSE(test::hazy_box()->has_scattering_media());
}

/// Sums contributions of paths that are scattered once.
struct Sum {
    Rgb value{0.0};
    static bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }
    void contribution(const EyeWalk& /*walk*/, const Vertex& /*x0*/, const Rgb& v, LightClass /*light*/) { value += v; }
};

/// Light of a point beside a ray, scattered once on the way: the integral over the ray is taken in small steps.
TEST(Media_SingleScattering, IsItsIntegral) {
    const auto medium = puff();
    const Vec3 light(0.4f, 0.5f, 0.2f);
    const Rgb intensity(2, 3, 4);
    test::SceneMaker m;
    m.cloud({-1, -1, -1}, {1, 1, 1}, medium)
        .rectangle({-9, -9, -5}, {18, 0, 0}, {0, 18, 0}, make_diffuse(Rgb(0.0)))
        .emitter(make_point_emitter(light, intensity))
        .camera({0, 0, 4}, {0, 0, 0}, 20)
        .window(8, 8);
    const auto scene = m.build();
    const Vec2 image(0.4f, 0.55f);
    Rng numbers(1, StreamPurpose::test, 0);
    const Vertex eye = sample_eye(*scene, numbers);
    const Vec3 w = scene->camera().ray_direction(eye.point, image);
    SurfacePoint lamp;
    lamp.p = light;
    lamp.site = Site::point;
    constexpr int kSteps = 4000;
    Rgb expected(0.0);
    for (int i = 0; i < kSteps; ++i) {
        const double t = 2 + 4 * (i + 0.5) / kSteps;
        SurfacePoint x = lamp;
        x.p = eye.point.p + w * static_cast<float>(t);
        const Vec3 to_light = light - x.p;
        const double density = medium->density->density(x.p), g = 0.4,
                     cosine = -static_cast<double>(to_light.normalized().dot(-w)),
                     p = (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
        expected += medium->scattering * intensity * scene->transmittance(x, lamp) *
                    scene->transmittance(eye.point, x) * (density * p / to_light.length2() * 4 / kSteps);
    }
    RunningStats mean[3];
    for (std::uint64_t i = 0; i < 40'000; ++i) {
        Rng rng(1, StreamPurpose::test, i + 1);
        Sum sum;
        trace_path(*scene, image, 1, rng, sum);
        for (int k = 0; k < 3; ++k) mean[k].add(sum.value[k]);
    }
    for (int k = 0; k < 3; ++k) {
        EXPECT_TRUE(test::has_mean(mean[k], expected[k], 3, 1e-3)) << k;
        EXPECT_LT(mean[k].standard_error(), 0.01 * expected[k]);
    }
}

} // namespace
} // namespace keyhole
