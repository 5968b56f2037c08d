// Next-event estimation that has learned: densities that are those of the samples, light that arrives in full, and far
// less noise where light comes through a window or from few of many lamps.
#include "core/statistics.h"
#include "sampling/guidance/learned/look_for_direct_light.h"
#include "sampling/paths/direct_light.h"
#include "scene/bsdfs/diffuse.h"
#include "scene/emitters/emitters.h"
#include "scene/emitters/sphere_map.h"
#include "scene/load/load.h"
#include "scene/warp.h"
#include "support/chance.h"
#include "support/chi_squared.h"
#include "support/test_scenes.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace keyhole {
namespace {

/// Thirty lamps, each in a closed room of its own; the eye sees the first. The second has a sliver of a door to it.
test::SceneMaker many_rooms() {
    const auto wall = make_diffuse(Rgb(0.5));
    test::SceneMaker m;
    for (int i = 0; i < 30; ++i) {
        const auto x = static_cast<float>(10 * i);
        if (i > 1) m.room({x - 1, -1, -2}, {x + 1, 1, 2}, wall);
        m.rectangle({x - 0.2f, 0.99f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, make_diffuse(Rgb(0.0)), Rgb(5));
    }
    m.rectangle({-1, -1, -2}, {0, 0, 4}, {12, 0, 0}, wall);
    m.rectangle({-1, 1, -2}, {12, 0, 0}, {0, 0, 4}, wall);
    m.rectangle({-1, -1, -2}, {12, 0, 0}, {0, 2, 0}, wall);
    m.rectangle({-1, -1, 2}, {0, 2, 0}, {12, 0, 0}, wall);
    m.rectangle({-1, -1, -2}, {0, 2, 0}, {0, 0, 4}, wall);
    m.rectangle({11, -1, -2}, {0, 0, 4}, {0, 2, 0}, wall);
    m.rectangle({1, -1, -1.99f}, {0, 2, 0}, {0, 0, 3.99f}, wall);
    m.camera({0, 0, 1.9f}, {0, -0.5f, 0}, 60).window(32, 24);
    return m;
}

Vertex white_vertex(const Vec3& p, const Vec3& n) {
    Vertex v;
    v.point.p = p;
    v.point.ng = v.point.ns = n;
    v.point.offset = 1e-5f;
    v.bsdf = Bsdf(Frame(n), DiffuseBsdf{Rgb(1.0)});
    return v;
}

struct Places {
    Vec3 lower, upper, n;
};

/// What next-event estimation by a sampler brings to places of a rectangle, visibility included.
RunningStats arriving(const Scene& scene, const DirectLightSampler* sampler, const Places& places, int samples,
                      double planted = 1) {
    RunningStats stats;
    for (int i = 0; i < samples; ++i) {
        Rng rng(sampler != nullptr ? 31 : 32, StreamPurpose::test, static_cast<std::uint64_t>(i));
        Vec3 p;
        for (int k = 0; k < 3; ++k)
            p[k] = places.lower[k] + static_cast<float>(rng.next()) * (places.upper[k] - places.lower[k]);
        const Vertex v = white_vertex(p, places.n);
        auto [x0, pdf] = sampler != nullptr ? sampler->sample(v.point, rng) : sample_by_light_tree(scene, v.point, rng);
        const Vec3 w = direction(v.point, x0);
        double value = 0;
        if (pdf > 0 && w.dot(places.n) > 0 && scene.visible(v.point, x0, w))
            value = luminance(scene.emitter(x0.emitter).radiance(x0, -w)) * geometry_term(v.point, x0, w) / pdf;
        stats.add(value * planted);
    }
    return stats;
}

double z_score(const RunningStats& a, const RunningStats& b) {
    return (a.mean() - b.mean()) / std::hypot(a.standard_error(), b.standard_error());
}

constexpr Places kFloor{{0.2f, 0, 0.2f}, {2.8f, 0, 2.8f}, {0, 1, 0}};

/// Rays from places of a floor of 2 x 2 m to a window of 1 x 0.5 m whose middle is 2 m above its edge.
std::vector<DirectionHistogram::Ray> rays_through_a_window(int n, std::uint64_t stream) {
    std::vector<DirectionHistogram::Ray> rays;
    Rng rng(8, StreamPurpose::test, stream);
    const auto number = [&](double low, double high) { return static_cast<float>(low + (high - low) * rng.next()); };
    for (int i = 0; i < n; ++i) {
        const Vec3 p(number(-1, 1), 0, number(0, 2)), at(number(-0.5, 0.5), number(1.75, 2.25), -0.5f);
        rays.push_back({p, (at - p).normalized(), number(0.5, 1.5)});
    }
    return rays;
}

TEST(DirectionHistogram, FindsTheWindowThatRaysMeetIn) {
    const auto rays = rays_through_a_window(400, 0);
    const auto plane = DirectionHistogram::meeting_plane(rays);
    ASSERT_TRUE(plane);
    EXPECT_NEAR(plane->center.z, -0.5, 0.4);
    EXPECT_NEAR(plane->center.y, 2, 0.5);
    const DirectionHistogram histogram(rays, plane);
    ASSERT_FALSE(histogram.empty());
    Rng rng(9, StreamPurpose::test, 0);
    const Vec3 p(0.8f, 0, 0.3f);
    int through = 0;
    double area = 0; // solid angle that samples fill, as 1 / pdf has it
    constexpr int n = 20'000;
    for (int i = 0; i < n; ++i) {
        const double u0 = rng.next();
        const Vec3 w = histogram.sample(p, u0, rng.next());
        const double pdf = histogram.pdf(p, w);
        ASSERT_GT(pdf, 0);
        const Vec3 at = p + w * ((-0.5f - p.z) / w.z);
        through += w.z < 0 && std::abs(at.x) < 0.5f && std::abs(at.y - 2) < 0.25f ? 1 : 0;
        area += 1 / pdf / n;
    }
    EXPECT_GT(through, 0.4 * n);
    EXPECT_LT(area, 3); // of 4 pi; some go by the map of all directions
    // Its density adds up to 1 over the sphere.
    double sum = 0;
    constexpr int side = 1500;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            sum += histogram.pdf(p, sphere_direction(SphereLayout::octahedral, {(x + 0.5) / side, (y + 0.5) / side}));
    EXPECT_NEAR(sum * 4 * kPi / (side * side), 1, 0.01);
}

/// From a place in whose view rays through the window make but a narrow cone: what samples do there, and what the
/// density says of it.
template <class Histogram> void expect_density_of_samples(const Histogram& histogram, const Vec3& p) {
    SCOPED_TRACE(testing::Message() << p);
    const Vec3 axis = (Vec3(0, 2, -0.5f) - p).normalized();
    const double cos_edge = std::cos(0.15), solid_angle = 2 * kPi * (1 - cos_edge);
    constexpr int n = 400'000;
    Rng rng(11, StreamPurpose::test, 0);
    RunningStats inside, density;
    for (int i = 0; i < n; ++i) {
        double u0 = rng.next();
        const Vec3 w = histogram.sample(p, u0, rng.next());
        ASSERT_GT(histogram.pdf(p, w), 0) << w;
        inside.add(w.dot(axis) > cos_edge ? 1 : 0);
        u0 = rng.next();
        density.add(solid_angle * histogram.pdf(p, Frame(axis).to_world(uniform_cone(u0, rng.next(), cos_edge))));
    }
    EXPECT_NEAR(inside.mean(), density.mean(), 4 * std::hypot(inside.standard_error(), density.standard_error()));
}

TEST(DirectionHistogram, HasTheDensityOfItsSamplesFromWhereverItIsAsked) {
    const auto rays = rays_through_a_window(400, 0);
    const DirectionHistogram histogram(rays, DirectionHistogram::Plane{{0, 2, -0.5f}, {0, 0, -1}});
    expect_density_of_samples(histogram, {0.8f, 0, 0.3f});
    expect_density_of_samples(histogram, {9, 2, -0.4f}); // from the side: directions are flat to the plane
    expect_density_of_samples(histogram, {-4, 1.5f, -0.45f});
    expect_density_of_samples(histogram, {0.5f, 1, -3});   // from behind
    expect_density_of_samples(histogram, {6, 2, -0.5f});   // in the plane
    expect_density_of_samples(histogram, {6, 2, -0.501f}); // nearly
}

/// The rays of a cell that pass the left quarter of the window, and all.
TEST(NestedHistogram, KnowsOfThePartOfAWindowThatItsOwnRaysMissed) {
    const DirectionHistogram::Plane plane{{0, 2, -0.5f}, {0, 0, -1}};
    const auto all = rays_through_a_window(400, 0);
    std::vector<DirectionHistogram::Ray> some;
    for (const auto& ray : all)
        if ((ray.p + ray.w * ((-0.5f - ray.p.z) / ray.w.z)).x < -0.25f) some.push_back(ray);
    const std::array<DirectionMixture::Group, 1> group{{{plane.center, true, plane}}};
    const auto wider = std::make_shared<const DirectionMixture>(all, group);
    const DirectionMixture own(some, group);
    const NestedHistogram nested(own, wider), alone(own, nullptr);
    const Vec3 p(0.8f, 0, 0.3f), missed = (Vec3(0.3f, 2, -0.5f) - p).normalized();
    const DirectionHistogram::Place on_map = DirectionHistogram::place_on_map(missed);
    EXPECT_GT(wider->pdf(p, missed, on_map), 100 * own.pdf(p, missed, on_map));
    EXPECT_EQ(alone.pdf(p, missed), own.pdf(p, missed, on_map));
    EXPECT_GT(nested.pdf(p, missed), 0.2 * wider->pdf(p, missed, on_map));
    expect_density_of_samples(nested, p);
    expect_density_of_samples(alone, p);
}

/// A window to the left of the floor as well, so that rays meet in no plane.
TEST(DirectionMixture, FindsWindowsInTwoWalls) {
    auto rays = rays_through_a_window(200, 0);
    for (DirectionHistogram::Ray ray : rays_through_a_window(200, 1)) {
        const Vec3 at = ray.p + ray.w * ((-0.5f - ray.p.z) / ray.w.z); // on the other window, turned about the floor
        ray.p = {ray.p.x, 0, ray.p.z};
        ray.w = (Vec3(-1.5f, at.y - 0.5f, 1 + at.x) - ray.p).normalized();
        rays.push_back(ray);
    }
    const auto groups = DirectionMixture::groups_of(rays);
    ASSERT_GE(groups.size(), 2u);
    const DirectionMixture mixture(rays, groups);
    const NestedHistogram two(mixture, nullptr),
        one({rays,
             std::vector<DirectionMixture::Group>{{Vec3(0, 0, 1), false, DirectionHistogram::meeting_plane(rays)}}},
            nullptr);
    const Vec3 p(0.3f, 0, 0.8f);
    const auto through = [&](const NestedHistogram& directions) {
        Rng rng(12, StreamPurpose::test, 0);
        int n = 0;
        for (int i = 0; i < 10'000; ++i) {
            const double u0 = rng.next();
            const Vec3 w = directions.sample(p, u0, rng.next());
            const Vec3 ahead = p + w * ((-0.5f - p.z) / w.z), left = p + w * ((-1.5f - p.x) / w.x);
            n += w.z < 0 && std::abs(ahead.x) < 0.5f && std::abs(ahead.y - 2) < 0.25f ? 1 : 0;
            n += w.x < 0 && std::abs(left.z - 1) < 0.5f && std::abs(left.y - 1.5f) < 0.25f ? 1 : 0;
        }
        return n;
    };
    EXPECT_GT(through(two), 5500);
    EXPECT_GT(through(two), 1.5 * through(one));
    for (const Vec3& at : {p, Vec3(9, 2, -0.4f), Vec3(-1.5f, 1, 3), Vec3(-4, 1.5f, -0.45f)}) {
        expect_density_of_samples(two, at);
        expect_density_of_samples(one, at);
    }
}

TEST(DirectionMixture, OfRaysThroughOneWindowIsItsHistogram) {
    const auto rays = rays_through_a_window(60, 0);
    const auto groups = DirectionMixture::groups_of(rays);
    ASSERT_EQ(groups.size(), 1u);
    const DirectionMixture mixture(rays, groups);
    const DirectionHistogram histogram(rays, groups[0].plane);
    const Vec3 p(0.8f, 0, 0.3f);
    for (const auto& ray : rays) {
        const Vec3 w = (ray.p + ray.w * 3.0f - p).normalized();
        EXPECT_NEAR(mixture.pdf(p, w, DirectionHistogram::place_on_map(w)), histogram.pdf(p, w), 1e-6);
    }
    EXPECT_TRUE(DirectionMixture(std::span(rays).first(1), groups).empty());
}

TEST(DirectionHistogram, KeepsDirectionsWhereRaysDoNotMeet) {
    std::vector<DirectionHistogram::Ray> rays; // of directions in a narrow cone, from everywhere
    Rng rng(10, StreamPurpose::test, 0);
    const auto number = [&](double low, double high) { return static_cast<float>(low + (high - low) * rng.next()); };
    for (int i = 0; i < 400; ++i)
        rays.push_back(
            {{number(-9, 9), 0, number(-9, 9)}, Vec3(number(-0.1, 0.1), 1, 1 + number(-0.1, 0.1)).normalized(), 1});
    EXPECT_FALSE(DirectionHistogram::meeting_plane(rays));
    const DirectionHistogram histogram(rays, {});
    double sum = 0;
    for (int i = 0; i < 5000; ++i) {
        const double u0 = rng.next();
        const Vec3 w = histogram.sample({100, 0, 0}, u0, rng.next());
        sum += 1 / histogram.pdf({100, 0, 0}, w) / 5000;
    }
    EXPECT_LT(sum, 0.5) << "as narrow anywhere else";
}

TEST(LearnedDirectLight, StaysWithinItsMemory) {
    test::SceneMaker m;
    m.room({0, 0, 0}, {20, 3, 20}, make_diffuse(Rgb(0.5)));
    for (int x = 0; x < 20; ++x) {
        for (int z = 0; z < 20; ++z) {
            const Vec3 at(static_cast<float>(x), 2.9f, static_cast<float>(z));
            m.rectangle(at + Vec3(0.4f, 0, 0.4f), {0.2f, 0, 0}, {0, 0, 0.2f}, make_diffuse(Rgb(0.0)), Rgb(9.0));
            m.rectangle(at, {0, -0.8f, 0}, {0.9f, 0, 0}, make_diffuse(Rgb(0.3))); // a baffle
        }
    }
    m.camera({1, 1.5f, 1}, {19, 1, 19}, 70).window(32, 24);
    const auto scene = m.build();
    std::size_t told = 0, last = 0;
    for (const std::size_t most : {50'000, 200'000, 800'000, 3'200'000}) {
        const auto learned = learn_direct_light(*scene, {.paths = 32'768, .most_bytes = most}, {});
        if (!learned) continue; // so little is known of 400 lamps that it is no help
        ++told;
        EXPECT_LE(learned->bytes(), most);
        EXPECT_GT(learned->bytes(), last);
        last = learned->bytes();
    }
    EXPECT_GE(told, 2u);
}

class LearnedDirectLight_Window : public testing::Test {
  protected:
    static std::unique_ptr<Scene> make() {
        auto m = test::room_with_a_window();
        m.camera({1.5f, 1.3f, 2.9f}, {1.5f, 1.0f, 0}, 80).window(32, 24);
        m.emitter(make_constant_environment(Rgb(1, 2, 3)));
        m.emitter(make_distant_emitter(Vec3(0.2f, -0.6f, 0.7f).normalized(), Rgb(3)));
        return m.build();
    }
    const std::unique_ptr<Scene> scene = make();
    const std::shared_ptr<const LearnedDirectLight> learned = learn_direct_light(*scene, {.paths = 16'384}, {});
};

TEST_F(LearnedDirectLight_Window, HasTheDensityOfItsSamples) {
    ASSERT_TRUE(learned);
    constexpr int kSide = 8, kSamples = 60'000, kQuadrature = 40;
    for (const Vec3& p : {Vec3(1.5f, 0, 1.5f), Vec3(0.4f, 0, 2.5f)}) {
        const Vertex v = white_vertex(p, {0, 1, 0});
        test::Histogram h;
        h.observed.assign(kSide * kSide + 1, 0); // the last: the sun
        h.expected.assign(kSide * kSide + 1, 0);
        const auto bin = [](const Vec2d& place) {
            const auto at = [](double x) { return std::min(static_cast<int>(x * kSide), kSide - 1); };
            return static_cast<std::size_t>(at(place.y) * kSide + at(place.x));
        };
        Rng rng(6, StreamPurpose::test, 0);
        std::uint32_t sky = 0;
        SurfacePoint sun;
        for (int i = 0; i < kSamples; ++i) {
            const EmitterPoint x0 = learned->sample(v.point, rng);
            ASSERT_NEAR(x0.pdf, learned->pdf(v.point, x0.point), 1e-9 * x0.pdf);
            if (scene->emitter(x0.point.emitter).is_delta()) {
                h.observed.back() += 1;
                sun = x0.point;
            } else {
                sky = x0.point.emitter;
                h.observed[bin(sphere_place(SphereLayout::octahedral, x0.point.p))] += 1;
            }
        }
        h.expected.back() = kSamples * learned->pdf(v.point, sun);
        constexpr int n = kSide * kQuadrature;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const Vec2d place((x + 0.5) / n, (y + 0.5) / n);
                SurfacePoint x0 = infinite_point(sphere_direction(SphereLayout::octahedral, place));
                x0.emitter = sky;
                h.expected[bin(place)] += kSamples * learned->pdf(v.point, x0) * 4 * kPi / (n * n);
            }
        double all = 0;
        for (std::size_t i = 0; i < h.expected.size(); ++i) {
            all += h.expected[i];
            EXPECT_NEAR(h.observed[i], h.expected[i], 5 * std::sqrt(h.expected[i] + 1) + 0.08 * h.expected[i]) << i;
        }
        EXPECT_NEAR(all / kSamples, 1, 0.02);
    }
}

TEST_F(LearnedDirectLight_Window, TellsTheChancesOfItsSamples) {
    ASSERT_TRUE(learned);
    constexpr int kSamples = 40'000, kDirections = 6;
    const Vertex v = white_vertex({1.5f, 0, 1.5f}, {0, 1, 0});
    const std::vector<EmitterChance> chances = learned->chances(v.point, kDirections);
    ASSERT_FALSE(chances.empty());
    std::map<std::uint32_t, int> drawn;
    Rng rng(8, StreamPurpose::test, 0);
    for (int i = 0; i < kSamples; ++i) ++drawn[learned->sample(v.point, rng).point.emitter];
    double before = 1, told = 0;
    int likely = 0, directions = 0;
    for (const EmitterChance& chance : chances) {
        const double p = chance.probability, n = drawn[chance.emitter];
        EXPECT_LT(std::abs(n - kSamples * p), test::most_errors(2) * std::sqrt(kSamples * p * (1 - p)) + 1)
            << n << " " << p;
        EXPECT_LE(p, before);
        before = p;
        told += p;
        for (const Vec3& w : chance.towards) {
            SurfacePoint x0 = infinite_point(w);
            x0.emitter = chance.emitter;
            likely += learned->pdf(v.point, x0) > 1 / (4 * kPi) ? 1 : 0; // than any other direction
            ++directions;
        }
    }
    EXPECT_LE(told, 1 + 1e-9);
    EXPECT_GE(likely, 0.8 * directions);
    EXPECT_TRUE(std::ranges::any_of(chances, [](const auto& c) { return c.towards.size() == kDirections; }));
}

TEST_F(LearnedDirectLight_Window, BringsAllLightWithATenthOfTheVariance) {
    ASSERT_TRUE(learned);
    EXPECT_LT(learned->second_moment_ratio(), 0.2);
    const RunningStats plain = arriving(*scene, nullptr, kFloor, 600'000);
    const RunningStats aimed = arriving(*scene, learned.get(), kFloor, 100'000);
    EXPECT_LT(std::abs(z_score(plain, aimed)), 4) << plain.mean() << " " << aimed.mean();
    // At one place: what differs from place to place is no noise.
    constexpr Places kPlace{{0.8f, 0, 2.2f}, {0.8f, 0, 2.2f}, {0, 1, 0}};
    EXPECT_LT(arriving(*scene, learned.get(), kPlace, 50'000).variance(),
              0.1 * arriving(*scene, nullptr, kPlace, 200'000).variance());
    EXPECT_GT(std::abs(z_score(plain, arriving(*scene, learned.get(), kFloor, 100'000, 1.2))), 4)
        << "a density that is wrong by a fifth has to show";
}

/// A curtain covers half of the window: what is seen of that changes within a few hands' breadths.
TEST(LearnedDirectLight, LeavesNoStripOfTheSkyToChance) {
    const Scene scene(load_scene(KEYHOLE_SOURCE_DIR "/scenes/bedroom.yaml").description);
    const auto learned = learn_direct_light(scene, {.paths = 65'536}, {});
    ASSERT_TRUE(learned);
    Rng rng(5, StreamPurpose::test, 0);
    std::vector<RunningStats> places;
    RunningStats all;
    for (int i = 0; i < 600; ++i) {
        const Vertex eye = sample_eye(scene, rng);
        const double x = rng.next();
        const Vec3 w = scene.camera().ray_direction(eye.point, Vec2(Imath::V2d(x, rng.next())));
        const auto at = scene.trace(eye.point, w);
        if (!at || at->site != Site::surface) continue;
        const Vec3 n = facing(at->ng, -w);
        places.push_back(arriving(scene, learned.get(), {at->p, at->p, n}, 2000));
        all.add(places.back().mean());
    }
    const double dark = 0.1 * all.mean() * all.mean();
    std::vector<double> noise; // relative variance; what is nearly dark doesn't show
    for (const RunningStats& p : places) noise.push_back(p.variance() / (p.mean() * p.mean() + dark));
    std::ranges::sort(noise);
    EXPECT_LT(noise[noise.size() * 9 / 10], 5.5);
}

TEST(LearnedDirectLight_ManyLamps, FindsTheOneThatShinesAndLosesNone) {
    const auto scene = many_rooms().build();
    const auto learned = learn_direct_light(*scene, {.paths = 16'384}, {});
    ASSERT_TRUE(learned);
    const Places floor{{-0.9f, -1, -1.9f}, {0.9f, -1, 1.9f}, {0, 1, 0}};
    const RunningStats plain = arriving(*scene, nullptr, floor, 200'000);
    const RunningStats aimed = arriving(*scene, learned.get(), floor, 200'000);
    EXPECT_LT(std::abs(z_score(plain, aimed)), 4) << plain.mean() << " " << aimed.mean();
    EXPECT_LT(aimed.variance(), 0.5 * plain.variance());
    // Beyond the sliver hardly a path of the eye's came.
    const Places hidden{{9, -1, -1.9f}, {11, -1, 1.9f}, {0, 1, 0}};
    const RunningStats all = arriving(*scene, nullptr, hidden, 200'000);
    const RunningStats found = arriving(*scene, learned.get(), hidden, 200'000);
    EXPECT_GT(all.mean(), 0.1);
    EXPECT_LT(std::abs(z_score(all, found)), 4) << all.mean() << " " << found.mean();
}

TEST(LearnedDirectLight, LearnsNothingWhereThereIsNoChoiceOrNoGain) {
    const auto box = test::diffuse_box();
    EXPECT_FALSE(has_choice_of_direct_light(*box));
    EXPECT_FALSE(learn_direct_light(*box, {.paths = 16'384}, {}));
    test::SceneMaker open; // all of the sky is seen
    open.rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, make_diffuse(Rgb(0.5)));
    open.emitter(make_constant_environment(Rgb(1.0))).camera({0, 2, 4}, {0, 0, 0}, 60).window(32, 24);
    const auto plane = open.build();
    EXPECT_TRUE(has_choice_of_direct_light(*plane));
    const auto learned = learn_direct_light(*plane, {.paths = 16'384}, {});
    if (learned) {
        // Half of the sphere lies under the plane: no more than that is to be gained.
        EXPECT_GT(learned->second_moment_ratio(), 0.45);
    }
}

TEST(LearnedDirectLight, FallsBackOnTheLightTreeWhereNothingWasFound) {
    auto m = test::room_with_a_window();
    m.camera({1.5f, 1.3f, 2.9f}, {1.5f, 1.0f, 0}, 80).window(32, 24);
    m.emitter(make_constant_environment(Rgb(1.0)));
    const auto scene = m.build();
    const LearnedDirectLight nothing(*scene, {});
    const Vertex v = white_vertex({1.5f, 0, 1.5f}, {0, 1, 0});
    Rng rng(7, StreamPurpose::test, 0);
    for (int i = 0; i < 100; ++i) {
        const EmitterPoint x0 = nothing.sample(v.point, rng);
        EXPECT_DOUBLE_EQ(x0.pdf, light_tree_pdf(*scene, v.point, x0.point));
    }
}

/// Lamps 2 m above a street, 4 m apart, each of which shines on the piece below it alone, and two finds of each of the
/// first `known`.
class Street {
  public:
    static constexpr int kLamps = 64;

    explicit Street(int known) {
        test::SceneMaker m;
        for (int i = 0; i < kLamps; ++i)
            m.rectangle({4.0f * static_cast<float>(i), 2, 0}, {0.1f, 0, 0}, {0, 0, 0.1f}, make_diffuse(Rgb(0.0)),
                        Rgb(5));
        scene = m.camera({0, 1, 5}, {0, 0, 0}, 60).window(32, 24).build();
        Rng rng(12, StreamPurpose::test, 0);
        for (int i = 0; i < 2 * known; ++i) {
            const auto lamp = static_cast<std::uint32_t>(i / 2);
            const SurfacePoint at = below(i / 2, static_cast<float>(i % 2));
            SurfacePoint x0 = scene->emitter(lamp).sample_point(rng).point;
            x0.emitter = lamp;
            points.push_back(x0);
            const Vec3 w = direction(at, x0);
            const double choice = scene->light_tree().probability(at, lamp);
            const double point_pdf = scene->emitter(lamp).point_pdf(x0);
            found.push_back({.at = {at.p, at.ng},
                             .emitter = lamp,
                             .infinite = false,
                             .towards = w,
                             .value = 5 * geometry_term(at, x0, w),
                             .choice = choice,
                             .point_pdf = point_pdf,
                             .density = choice * point_pdf});
        }
    }
    static SurfacePoint below(int lamp, float z = 0.5f) {
        return white_vertex({4.0f * static_cast<float>(lamp), 0, z}, {0, 1, 0}).point;
    }
    double by_tree(int at, std::uint32_t lamp) const { return scene->light_tree().probability(below(at), lamp); }

    std::unique_ptr<Scene> scene;
    std::vector<FoundLight> found;
    std::vector<SurfacePoint> points; ///< on the lamps, by find
};

/// With finds along all of the street there is one cell for all lamps, whose middle is far from most.
TEST(LearnedDirectLight, AsksTheLightTreeForEachPlaceWhereThatPays) {
    const Street street(Street::kLamps);
    const LearnedDirectLight learned(*street.scene, street.found);
    ASSERT_LE(learned.cells(), 2u);
    for (const int lamp : {0, 20, 63})
        EXPECT_GT(learned.probability(Street::below(lamp), static_cast<std::uint32_t>(lamp)),
                  0.3 * street.by_tree(lamp, static_cast<std::uint32_t>(lamp)));
    for (std::size_t i = 0; i < street.found.size(); ++i) {
        const SurfacePoint at = Street::below(static_cast<int>(i / 2), static_cast<float>(i % 2));
        EXPECT_DOUBLE_EQ(learned.pdf(street.found[i]), learned.pdf(at, street.points[i]));
    }
}

TEST(LearnedDirectLight, KnowsNothingFarBeyondItsFinds) {
    Street street(4);
    const std::vector<FoundLight> few = street.found;
    while (street.found.size() < 512) street.found.insert(street.found.end(), few.begin(), few.end());
    const LearnedDirectLight learned(*street.scene, street.found);
    EXPECT_GT(learned.probability(Street::below(2), 2), 0.01);
    EXPECT_FALSE(learned.chances(Street::below(1), 0).empty());
    for (const std::uint32_t lamp : {3, 59, 60})
        EXPECT_EQ(learned.probability(Street::below(60), lamp), street.by_tree(60, lamp));
}

} // namespace
} // namespace keyhole
