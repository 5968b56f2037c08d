// Light paths that begin where their light will be asked for: densities that are those of the samples, power that
// arrives in full, and far more of the paths where they count.
#include "core/statistics.h"
#include "sampling/guidance/learned/learned_emission.h"
#include "sampling/paths/light_tracer.h"
#include "scene/emitters/emitters.h"
#include "support/chi_squared.h"
#include "support/test_scenes.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

constexpr int kDepth = 6;

std::vector<PlaneHistogram::Point> clustered_points(int n) {
    std::vector<PlaneHistogram::Point> points;
    Rng rng(5, StreamPurpose::test, 1);
    for (int i = 0; i < n; ++i) {
        const double x = rng.next(), y = rng.next();
        points.push_back(i % 5 == 0 ? PlaneHistogram::Point{{x, 3 * y}, 1}
                                    : PlaneHistogram::Point{{0.2 + 0.1 * x, y}, 2});
    }
    return points;
}

TEST(PlaneHistogram, HasTheDensityOfItsSamples) {
    auto points = clustered_points(500);
    const PlaneHistogram histogram(points, 8, {{0, 0}, {1, 3}});
    ASSERT_FALSE(histogram.empty());
    constexpr int kCells = 12, kSamples = 100'000, kQuadrature = 20;
    test::Histogram h;
    h.observed.assign(kCells * kCells, 0);
    h.expected.assign(kCells * kCells, 0);
    Rng rng(6, StreamPurpose::test, 0);
    for (int i = 0; i < kSamples; ++i) {
        const double u = rng.next();
        const auto place = histogram.sample(u, rng.next());
        const int x = std::min(static_cast<int>(place.x * kCells), kCells - 1);
        const int y = std::min(static_cast<int>(place.y / 3 * kCells), kCells - 1);
        h.observed[static_cast<std::size_t>(y * kCells + x)] += 1;
        EXPECT_GT(histogram.pdf(place), 0);
    }
    const double area = 3.0 / (kCells * kCells * kQuadrature * kQuadrature);
    for (int y = 0; y < kCells * kQuadrature; ++y)
        for (int x = 0; x < kCells * kQuadrature; ++x)
            h.expected[static_cast<std::size_t>(y / kQuadrature * kCells + x / kQuadrature)] +=
                kSamples * area *
                histogram.pdf({(x + 0.5) / (kCells * kQuadrature), 3 * (y + 0.5) / (kCells * kQuadrature)});
    double all = 0;
    for (std::size_t i = 0; i < h.expected.size(); ++i) all += h.expected[i];
    EXPECT_NEAR(all / kSamples, 1, 0.02);
    // Edges of rectangles cut cells of the quadrature: its errors are small beside 5 % of a cell.
    for (std::size_t i = 0; i < h.expected.size(); ++i)
        EXPECT_NEAR(h.observed[i], h.expected[i], 5 * std::sqrt(h.expected[i] + 1) + 0.06 * h.expected[i]) << i;
}

TEST(PlaneHistogram, IsEmptyWithoutAnArea) {
    std::vector<PlaneHistogram::Point> line{{{0, 1}, 1}, {{1, 1}, 1}, {{2, 1}, 1}};
    EXPECT_TRUE(PlaneHistogram(line, 8).empty());
    EXPECT_TRUE(PlaneHistogram().empty());
}

/// The room with a yard before its window, under a sky and a sun.
std::unique_ptr<Scene> room_in_a_yard() {
    auto m = test::room_with_a_window();
    m.rectangle({-4, -0.2f, -8}, {0, 0, 7.9f}, {10, 0, 0}, make_diffuse(Rgb(0.6)));
    m.emitter(make_constant_environment(Rgb(1, 2, 3)));
    m.emitter(make_distant_emitter(Vec3(0.2f, -0.6f, 0.7f).normalized(), Rgb(8)));
    m.camera({1.5f, 1.3f, 2.9f}, {1.5f, 1.2f, 0}, 60).window(32, 24);
    return m.build();
}

LearnedEmission learn(const Scene& scene, std::int64_t paths) {
    return {scene, look_for_light(scene, {.paths = paths, .max_scatterings = kDepth}, {}).ends};
}

/// Power that arrives at some walls, by the path.
struct Arrivals {
    RunningStats floor, ceiling, inside;
    std::int64_t paths_inside = 0;
};
template <class Emit> Arrivals trace(const Scene& scene, int paths, std::uint64_t stream, const Emit& emit) {
    struct Sink {
        double floor = 0, ceiling = 0, inside = 0;
        bool arrival(const Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast&) {
            const double y = luminance(power);
            if (v.point.p.z > 0.001f || v.point.ng.z > 0.5f) {
                const bool within = v.point.p.y > 2.499f ? to_light.y < 0 : v.point.p.x > 0 && v.point.p.x < 3;
                if (within) inside += y;
            }
            if (v.point.p.y > 2.499f && to_light.y < 0) ceiling += y;
            if (std::abs(v.point.p.y) < 0.001f && to_light.y > 0) floor += y;
            return true;
        }
    };
    Arrivals sum;
    for (int i = 0; i < paths; ++i) {
        Rng rng(stream, StreamPurpose::test, static_cast<std::uint64_t>(i));
        Sink sink;
        if (const auto light = emit(rng)) trace_light_path(scene, *light, kDepth, rng, sink);
        sum.floor.add(sink.floor);
        sum.ceiling.add(sink.ceiling);
        sum.inside.add(sink.inside);
        sum.paths_inside += sink.ceiling + sink.floor > 0 ? 1 : 0;
    }
    return sum;
}

double z_score(const RunningStats& a, const RunningStats& b) {
    return (a.mean() - b.mean()) / std::hypot(a.standard_error(), b.standard_error());
}

class LearnedEmissionInARoom : public testing::Test {
  protected:
    static constexpr int kPlainPaths = 2'000'000, kLearnedPaths = 200'000;
    const std::unique_ptr<Scene> scene = room_in_a_yard();
    const LearnedEmission learned = learn(*scene, 16'384);
};

TEST_F(LearnedEmissionInARoom, BringsAllPowerAndFindsTheWindow) {
    const Arrivals plain = trace(*scene, kPlainPaths, 11, [&](Rng& rng) { return emit_light(*scene, rng); });
    const Arrivals aimed = trace(*scene, kLearnedPaths, 12, [&](Rng& rng) { return learned.sample(rng); });
    EXPECT_LT(std::abs(z_score(plain.floor, aimed.floor)), 4) << plain.floor.mean() << " " << aimed.floor.mean();
    EXPECT_LT(std::abs(z_score(plain.ceiling, aimed.ceiling)), 4)
        << plain.ceiling.mean() << " " << aimed.ceiling.mean();
    EXPECT_LT(std::abs(z_score(plain.inside, aimed.inside)), 4) << plain.inside.mean() << " " << aimed.inside.mean();
    const double share = static_cast<double>(aimed.paths_inside) / kLearnedPaths;
    EXPECT_GT(share, 10 * static_cast<double>(plain.paths_inside) / kPlainPaths);
    // A density that is wrong by a fifth would not pass.
    const Arrivals again = trace(*scene, kLearnedPaths, 13, [&](Rng& rng) {
        auto light = learned.sample(rng);
        if (light) light->power *= 1.2;
        return light;
    });
    EXPECT_GT(std::max(std::abs(z_score(plain.ceiling, again.ceiling)), std::abs(z_score(plain.floor, again.floor))),
              4);
}

bool meets(const BoundingSphere& sphere, const EmitterRay& ray) {
    const Vec3 to = sphere.center - ray.origin.p;
    return to.cross(ray.w).length() <= sphere.radius;
}

/// The mean of the reciprocal density over that of emission by power is 1: a density that is not that of the samples
/// shows, wherever it is wrong.
void expect_density_of_edges(const Scene& scene, const LearnedEmission& learned) {
    RunningStats inverse;
    double most = 0;
    for (std::uint64_t i = 0; i < 400'000; ++i) {
        Rng rng(14, StreamPurpose::test, i);
        const auto light = learned.sample(rng);
        // What emission by power makes: on the side where a lamp shines, and within the scene's cross-section.
        const bool shines = light && !is_black(light->power) && meets(scene.bounding_sphere(), light->ray);
        const double over = shines ? 1 / learned.density_ratio(light->x0, light->ray.w, light->ray.origin.p) : 0;
        inverse.add(over);
        most = std::max(most, over);
    }
    EXPECT_NEAR(inverse.mean(), 1, 4 * inverse.standard_error());
    // A fifth of the edges aim at nothing, and half of their emitters are chosen by power.
    EXPECT_LT(most, 10 + 1e-3);
}

TEST_F(LearnedEmissionInARoom, HasTheDensityOfItsEdges) { expect_density_of_edges(*scene, learned); }

TEST_F(LearnedEmissionInARoom, HasTheDensityOfItsLinesThroughTheWindow) {
    // Of uniform light from all around, half the window's area over the scene's cross-section passes it; a fourth of
    // that from above, and into the room.
    RunningStats inverse;
    for (std::uint64_t i = 0; i < 400'000; ++i) {
        Rng rng(17, StreamPurpose::test, i);
        const auto light = learned.sample(rng);
        ASSERT_TRUE(light);
        const Vec3 &o = light->ray.origin.p, &w = light->ray.w, at = o - w * (o.z / w.z);
        const bool through = std::abs(at.x - 1.4f) < 0.4f && std::abs(at.y - 1.4f) < 0.4f && w.z > 0 && w.y < 0;
        const bool of_sky = is_environment(scene->emitter(light->x0.emitter));
        inverse.add(through && of_sky ? 1 / learned.density_ratio(light->x0, w, o) : 0);
    }
    const double radius = scene->bounding_sphere().radius;
    const double expected = scene->emitter_distribution().probability(0) * 0.125 * 0.64 / (kPi * radius * radius);
    EXPECT_LT(inverse.standard_error(), 0.02 * expected);
    EXPECT_NEAR(inverse.mean(), expected, 4 * inverse.standard_error());
}

TEST(LearnedEmission, HasTheDensityOfItsEdgesFromLamps) {
    const auto wall = make_diffuse(Rgb(0.5));
    test::SceneMaker m;
    m.room({-3, -1, -2}, {3, 1, 2}, wall);
    m.rectangle({0.5f, -1, -2}, {0, 2, 0}, {0, 0, 3.5f}, wall); // with a way past it
    for (int i = 0; i < 12; ++i) {
        const auto x = 0.45f * static_cast<float>(i) - 2.6f;
        m.rectangle({x - 0.1f, 0.99f, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}, make_diffuse(Rgb(0.0)), Rgb(5));
    }
    m.emitter(make_point_emitter(Vec3(2, 0.2f, -1), Rgb(1)));
    m.camera({-2.5f, 0, 1.9f}, {-2, 0, 0}, 60).window(32, 24);
    const auto scene = m.build();
    const LearnedEmission learned = learn(*scene, 16'384);
    expect_density_of_edges(*scene, learned);
    const Arrivals plain = trace(*scene, 200'000, 15, [&](Rng& rng) { return emit_light(*scene, rng); });
    const Arrivals aimed = trace(*scene, 200'000, 16, [&](Rng& rng) { return learned.sample(rng); });
    EXPECT_LT(std::abs(z_score(plain.inside, aimed.inside)), 4) << plain.inside.mean() << " " << aimed.inside.mean();
}

TEST(LearnedEmission, ChoosesTheLampsThatShineWhereTheEyeIs) {
    const auto wall = make_diffuse(Rgb(0.5));
    test::SceneMaker m;
    m.room({-1, -1, -2}, {1, 1, 2}, wall);
    for (int i = 0; i < 30; ++i) { // each in a closed room of its own, but for the first
        const auto x = static_cast<float>(10 * i);
        if (i > 0) m.room({x - 1, -1, -2}, {x + 1, 1, 2}, wall);
        m.rectangle({x - 0.2f, 0.99f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, make_diffuse(Rgb(0.0)), Rgb(5));
    }
    m.camera({0, 0, 1.9f}, {0, 0, 0}, 60).window(32, 24);
    const auto scene = m.build();
    const LearnedEmission learned = learn(*scene, 2048);
    EXPECT_LT(learned.effective_emitters(), 5);
    Rng rng(7, StreamPurpose::test, 0);
    int first = 0;
    RunningStats power;
    for (int i = 0; i < 20'000; ++i) {
        const auto light = learned.sample(rng);
        ASSERT_TRUE(light);
        first += std::abs(light->x0.p.x) < 1 ? 1 : 0;
        power.add(luminance(light->power));
    }
    EXPECT_GT(first, 9'000);                   // one in thirty by power
    const double of_all = 30 * kPi * 5 * 0.16; // [W]
    EXPECT_NEAR(power.mean(), of_all, 4 * power.standard_error());
}

TEST(LearnedEmission, IsForLightFromInfinity) {
    EXPECT_FALSE(LearnedEmission::can_learn(*test::diffuse_box()));
    EXPECT_TRUE(LearnedEmission::can_learn(*room_in_a_yard()));
}

TEST(LearnedEmission, KnowsNothingWhereNoLightWasSeenAndBringsItStill) {
    const auto scene = room_in_a_yard();
    const LearnedEmission nothing = learn(*scene, 0);
    const Arrivals plain = trace(*scene, 400'000, 21, [&](Rng& rng) { return emit_light(*scene, rng); });
    const Arrivals same = trace(*scene, 400'000, 22, [&](Rng& rng) { return nothing.sample(rng); });
    EXPECT_LT(std::abs(z_score(plain.inside, same.inside)), 4);
}

} // namespace
} // namespace keyhole
