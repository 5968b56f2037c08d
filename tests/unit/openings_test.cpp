// Openings that light has to pass are found where they are, and nowhere else.
#include "methods/render.h"
#include "sampling/guidance/found/find_openings.h"
#include "sampling/guidance/found/guidance_gain.h"
#include "sampling/guidance/found/passages.h"
#include "scene/load/load.h"
#include "support/test_scenes.h"
#include "support/user_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

namespace keyhole {
namespace {

OpeningSearch search(double least_gain = 0) { return {.pairs = 1 << 18, .least_gain = least_gain, .seed = 5}; }

OpeningsFound found_in(const Scene& scene, const OpeningSearch& search) {
    return find_openings(scene, trace_transport_ends(scene, 2048, search.seed, {}), search, {});
}

/// Where p lies in an opening along its edges, 0 to 1, and how far from its plane [m].
std::tuple<double, double, double> within(const Opening& o, const Imath::V3d& p) {
    const Imath::V3d offset = p - o.corner;
    return {offset.dot(o.u) / o.u.length2(), offset.dot(o.v) / o.v.length2(),
            std::abs(offset.dot(o.u.cross(o.v).normalized()))};
}

/// Whether `o` is the rectangle with these corners, but for a margin.
void expect_tight(const Opening& o, const std::array<Imath::V3d, 3>& corners) {
    constexpr double kSlack = 0.03;
    for (const Imath::V3d& corner : corners) {
        const auto [along, across, off] = within(o, corner);
        for (const double x : {along, across}) {
            EXPECT_LT(std::min(std::abs(x), std::abs(x - 1)), kSlack) << corner;
            EXPECT_GT(x, -1e-3) << corner;
            EXPECT_LT(x, 1 + 1e-3) << corner;
        }
        EXPECT_LT(off, 1e-3) << corner;
    }
}

class Slits : public testing::TestWithParam<float> {};

TEST_P(Slits, AreFoundAsTheyAre) {
    const double slit = GetParam();
    const auto scene = test::two_rooms(GetParam(), true);
    const OpeningsFound found = found_in(*scene, search());
    ASSERT_EQ(found.openings, 1);
    ASSERT_GE(found.paths.paths.size(), 6u);
    constexpr double plane = -0.0625;
    for (const Opening& o : openings_of(found.paths))
        expect_tight(o, {{{1.2, 0, plane}, {1.2 + slit, 0, plane}, {1.2, 2.5, plane}}});
}

// As light through it is worth: free paths go there in proportion to the width.
TEST_P(Slits, BringAsMuchAsTheyAreNarrow) {
    const auto scene = test::two_rooms(GetParam(), true);
    const double gain = found_in(*scene, search()).gain;
    EXPECT_GT(gain, 0.35 / GetParam());
    EXPECT_LT(gain, 1.6 / GetParam());
}

INSTANTIATE_TEST_SUITE_P(Widths, Slits, testing::Values(0.1f, 0.01f, 0.003f, 0.001f));

TEST(Openings, AreFoundInAWallAskew) {
    constexpr float kSlope = 0.3f, kFrom = 0.5f, kTo = 0.53f;
    const auto white = make_diffuse(Rgb(0.75));
    test::SceneMaker m;
    m.room({-2, 0, -4}, {2, 2.5f, 4}, white);
    const auto leaf = [&](float a, float b, float low, float high) {
        m.rectangle({a, low, kSlope * a}, {b - a, 0, kSlope * (b - a)}, {0, high - low, 0}, white);
    };
    leaf(-2, kFrom, 0, 2.5f);
    leaf(kTo, 2, 0, 2.5f);
    leaf(kFrom, kTo, 0, 0.9f);
    leaf(kFrom, kTo, 1.1f, 2.5f);
    m.rectangle({-1.6f, 2.45f, -2.6f}, {0.8f, 0, 0}, {0, 0, 0.8f}, make_diffuse(Rgb(0.0)), Rgb(200.0));
    m.camera({-1.5f, 1.4f, 3.7f}, {0.7f, 1, 0}, 58).window(64, 48);
    const OpeningsFound found = found_in(*m.build(), search());
    ASSERT_EQ(found.openings, 1);
    for (const Opening& o : openings_of(found.paths))
        expect_tight(o, {{{kFrom, 0.9, kSlope * kFrom}, {kTo, 0.9, kSlope * kTo}, {kFrom, 1.1, kSlope * kFrom}}});
}

TEST(Openings, OfAThickWallAreFoundAtItsFace) {
    const auto scene = test::two_rooms(0.02f);
    const OpeningsFound found = found_in(*scene, search());
    ASSERT_GE(found.openings, 1);
    for (const Opening& o : openings_of(found.paths)) {
        const auto [along, across, off] = within(o, {1.21, 1.2, -0.05});
        EXPECT_GT(std::min(along, across), 0);
        EXPECT_LT(std::max(along, across), 1);
        EXPECT_LT(off, 0.06);
    }
}

TEST(Openings, AreNotLookedForWhereLightFindsItsWay) {
    const auto finds_its_way = [](const Scene& scene) {
        return light_finds_its_way(scene, trace_transport_ends(scene, 1024, 3, {}), 3, {});
    };
    EXPECT_TRUE(finds_its_way(*test::diffuse_box()));
    EXPECT_TRUE(finds_its_way(*test::mirror_glass_box()));
    EXPECT_FALSE(finds_its_way(*test::two_rooms(0.1f)));
}

TEST(Openings, ThatBringLittleAreLeftOut) {
    const auto scene = test::two_rooms(0.1f, true);
    const OpeningsFound found = found_in(*scene, search(1e6));
    EXPECT_EQ(found.openings, 1);
    EXPECT_GT(found.gain, 1);
    EXPECT_TRUE(found.paths.paths.empty());
}

/// Rooms in a row with a lamp in each but the first, in which the eye is; only between that and the second is a door.
std::unique_ptr<Scene> rooms_in_a_row(int rooms) {
    const auto white = make_diffuse(Rgb(0.75));
    test::SceneMaker m;
    const auto length = static_cast<float>(3 * rooms);
    m.room({0, 0, 0}, {4, 2.5f, length}, white);
    for (int i = 1; i < rooms; ++i) {
        const auto z = static_cast<float>(3 * i);
        const float door = i == 1 ? 0.3f : 0;
        m.rectangle({door, 0, z}, {4 - door, 0, 0}, {0, 2.5f, 0}, white);
        m.rectangle({1.8f, 2.45f, z + 1.3f}, {0.4f, 0, 0}, {0, 0, 0.4f}, make_diffuse(Rgb(0.0)), Rgb(40.0));
    }
    return m.camera({2, 1.4f, 0.2f}, {2, 1.2f, 3}, 60).window(64, 48).build();
}

TEST(GainByGuides, OfDoorsIsSmallWhereTheRightLampsAreFoundWithoutThem) {
    const auto scene = rooms_in_a_row(30);
    const OpeningsFound by_power = found_in(*scene, search());
    ASSERT_GT(by_power.openings, 0);
    const LearnedEmission learned(*scene, look_for_light(*scene, {.paths = 4096, .max_scatterings = 24}, {}).ends);
    OpeningSearch with_learned = search();
    with_learned.learned = &learned;
    const double gain = found_in(*scene, with_learned).gain;
    EXPECT_LT(gain, by_power.gain / 2);
    EXPECT_GT(gain, 0.4) << "half of the paths are the free ones, whatever the others find";
}

// What leads through an opening that there isn't takes half of the light away from where it is wanted.
TEST(GainByGuides, IsNoneWherePathsLeadAstray) {
    const auto scene = test::diffuse_box();
    UserPathSpec path = test::user_path("through the air", {{0, 1.95f, 0}, {-0.5f, 0.5f, -1}}, 0.1);
    path.points[1].through = Opening{{-0.6, 0.4, -0.5}, {0.2, 0, 0}, {0, 0.2, 0}};
    path.points.insert(path.points.begin() + 1, UserPathPoint{.bounce = true});
    path.beta.push_back(0.1);
    path.tolerance = 2;
    const UserPaths paths = bind_user_paths(*scene, {{path}});
    const TransportEnds ends = trace_transport_ends(*scene, 1024, 3, {});
    const double gain = gain_by_guides(*scene, LightGuides(*scene, paths), ends.eye, 3, {});
    EXPECT_GT(gain, 0.2);
    EXPECT_LT(gain, 1.2);
}

Settings quick(Settings settings) {
    settings.method = &method_named("ipm");
    settings.light_paths = 40'000;
    settings.spp = 1;
    return settings;
}

TEST(FoundOpenings, AreUsedWithoutAWordAndCanBeTurnedOff) {
    auto loaded = load_scene(KEYHOLE_SOURCE_DIR "/scenes/failures/keyhole.yaml");
    Scene scene(std::move(loaded.description));
    Settings settings = quick(loaded.settings);
    const RenderResult led = render(scene, settings, {});
    EXPECT_EQ(led.stats.values.at("openings found"), 1);
    EXPECT_GT(led.stats.values.at("gain by openings"), 10);
    settings.find_openings = false;
    const RenderResult free = render(scene, settings, {});
    EXPECT_FALSE(free.stats.values.contains("openings found"));
}

/// They lead to where light comes by itself, not through the keyhole.
TEST(PathsOfUsers, ThatGainNothingAreNotPraised) {
    auto loaded = load_scene(KEYHOLE_SOURCE_DIR "/scenes/failures/keyhole.yaml");
    Scene scene(std::move(loaded.description));
    const Settings settings = quick(loaded.settings);
    UserPathSpec path = test::user_path("to the floor", {{0, 1.99f, -1.2f}, {0, 0, -1.2f}}, 0.1);
    path.points[1].through = Opening{{-0.5, 1, -1.5}, {1, 0, 0}, {0, 0, 0.6}};
    const RenderResult result = render(scene, settings, {}, {{path}});
    EXPECT_EQ(result.stats.values.at("gain by user paths"), 1);
    for (const std::string& remark : result.stats.remarks)
        EXPECT_EQ(remark.find("user paths"), std::string::npos) << remark;
}

/// Of keyhole.yaml, by ipm, with one path to the floor that is of no use; what leads there passes `through`.
RenderStats stats_beside(const std::optional<Opening>& through) {
    auto loaded = load_scene(KEYHOLE_SOURCE_DIR "/scenes/failures/keyhole.yaml");
    Scene scene(std::move(loaded.description));
    UserPathSpec path = test::user_path("to the floor", {{0, 1.99f, -1.2f}, {0, 0, -1.2f}}, 0.1);
    path.points[1].through = through;
    return render(scene, quick(loaded.settings), {}, {{path}}).stats;
}

TEST(PathsOfUsers, ThatGainNothingLeaveTheSearchForOpeningsOn) {
    for (const auto& through :
         {std::optional<Opening>(), std::optional<Opening>({{-0.5, 1, -1.5}, {1, 0, 0}, {0, 0, 0.6}})}) {
        const RenderStats stats = stats_beside(through);
        EXPECT_EQ(stats.values.at("openings found"), 1);
        EXPECT_GT(stats.values.at("gain by openings"), 10);
        EXPECT_THAT(stats.remarks, testing::Contains(testing::HasSubstr("beside the paths that are given")));
    }
}

TEST(Openings, ThatAreKnownAreNotFoundAgain) {
    const auto scene = test::two_rooms(0.02f, true);
    const auto found_beside = [&](const Opening& known) {
        OpeningSearch beside = search();
        beside.known.push_back(known);
        return found_in(*scene, beside).openings;
    };
    EXPECT_EQ(found_beside({{1.19, 0, -0.0625}, {0.04, 0, 0}, {0, 2.5, 0}}), 0);
    EXPECT_EQ(found_beside({{1.21, 1, -0.0625}, {0.001, 0, 0}, {0, 0.001, 0}}), 1) << "a pinhole is not all of it";
}

// Whatever light comes beside a pinhole within a slit, so few paths don't show it.
TEST(GainByGuides, IsNoMoreThanItsPathsCanTell) {
    const auto scene = test::two_rooms(0.02f, true);
    OpeningsFound found = found_in(*scene, search());
    for (UserPathSpec& spec : found.paths.paths)
        for (UserPathPoint& point : spec.points)
            if (point.through) point.through = Opening{{1.2095, 1, -0.0625}, {0.001, 0, 0}, {0, 0.001, 0}};
    std::erase_if(found.paths.paths, [&](const UserPathSpec& spec) { return !binds(*scene, spec); });
    ASSERT_FALSE(found.paths.paths.empty());
    const LightGuides guides(*scene, bind_user_paths(*scene, found.paths));
    const TransportEnds ends = trace_transport_ends(*scene, 1024, 3, {});
    const double gain = gain_by_guides(*scene, guides, ends.eye, 3, {});
    EXPECT_GT(gain, 1);
    EXPECT_LE(gain, 1024) << "of 2048 paths half are free";
}

// Pairs don't get fewer with the light paths of the render.
TEST(FoundOpenings, AreFoundWithLittleWork) {
    auto loaded = load_scene(KEYHOLE_SOURCE_DIR "/scenes/failures/keyhole.yaml");
    Scene scene(std::move(loaded.description));
    Settings settings = quick(loaded.settings);
    settings.light_paths = 2000;
    for (settings.seed = 1; settings.seed <= 4; ++settings.seed)
        EXPECT_TRUE(render(scene, settings, {}).stats.values.contains("openings found")) << settings.seed;
}

} // namespace
} // namespace keyhole
