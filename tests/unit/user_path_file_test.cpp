// Files of user paths: what is read, and that every mistake in one is a single clear error.
#include "core/error.h"
#include "sampling/guidance/user_paths.h"
#include "scene/load/load_mesh.h"
#include "support/scratch_directory.h"
#include "support/test_scenes.h"
#include "support/user_paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace keyhole {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string kGood = "points: [[0, 1.95, 0], [0.6, 0, -0.7], [-1, 1, 0.5]]";

const std::string kOpening = "{through: {corner: [0, 0.5, -0.2], u: [0.5, 0, 0], v: [0, 0.5, 0]}}";

/// A mistake in a file, and part of the message that it must give.
struct Mistake {
    std::string text, message;
};

Mistake in_path(const std::string& path, const std::string& message) {
    return {"paths:\n  - {" + path + "}\n", message};
}
Mistake in_point(const std::string& point, const std::string& message) {
    return in_path("points: [[0, 1.95, 0], " + point + ", [-1, 1, 0.5]]", message);
}
/// A file that can be read, but not used in mirror_glass_box().
Mistake in_scene(const std::string& path, const std::string& message) { return in_path("name: a, " + path, message); }

std::vector<Mistake> unreadable() {
    std::string many = "points: [";
    for (int i = 0; i < 40; ++i) many += "[0, " + std::to_string(i) + ", 0], ";
    return {
        {"", "empty file"},
        {"paths\n", "expected a map that describes user paths"},
        {"[1, 2]\n", "expected a map that describes user paths"},
        {"paths: [1, 2\n", "broken YAML"},
        {"beta: 5\n", "found user paths without 'paths'"},
        {"paths: []\n", "expected at least one user path"},
        {"paths: {}\n", "expected a list of user paths"},
        {"paths: 3\n", "expected a list of user paths"},
        {"path: []\npaths: []\n", "unknown key 'path'"},
        {"paths: [[0, 1, 2]]\n", "expected a map that describes a user path"},
        {"paths: [5]\n", "expected a map that describes a user path"},
        {"beta: 0\npaths: [{" + kGood + "}]\n", "an angle in degrees above 0"},
        {"beta: 91\npaths: [{" + kGood + "}]\n", "at most 90"},
        {"beta: [5, 5]\npaths: [{" + kGood + "}]\n", "expected an angle in degrees"},
        {"patch: 0\npaths: [{" + kGood + "}]\n", "expected a length"},
        {"tolerance: -1\npaths: [{" + kGood + "}]\n", "expected a length"},
        {"paths:\n  - {name: a, " + kGood + "}\n  - {name: a, " + kGood + "}\n", "the name 'a' again"},
        {"paths:\n  - {" + kGood + "}\npaths: []\n", "the key 'paths' again"},
        in_path("name: a", "found a user path without 'points'"),
        in_path("point: [], " + kGood, "unknown key 'point' in a user path"),
        in_path("beta: -3, " + kGood, "an angle in degrees above 0"),
        in_path("beta: .nan, " + kGood, "expected an angle in degrees"),
        in_path("beta: five, " + kGood, "found the value 'five', expected an angle in degrees"),
        in_path("beta: [5], " + kGood, "a list of 2: one for each segment"),
        in_path("beta: [5, 5, 5], " + kGood, "a list of 2: one for each segment"),
        in_path("beta: [5, x], " + kGood, "found the value 'x', expected an angle in degrees"),
        in_path("beta: {a: 5}, " + kGood, "expected an angle in degrees"),
        in_path("weight: 0, " + kGood, "a weight of at least 1e-06"),
        in_path("weight: -1, " + kGood, "a weight of at least 1e-06"),
        in_path("weight: [1], " + kGood, "expected a weight"),
        in_path("weight: 1e300, " + kGood, "at most 1e+06"),
        in_path("name: [a], " + kGood, "expected the name of a path"),
        in_path("name: '', " + kGood, "expected the name of a path"),
        in_path("patch: wide, " + kGood, "expected a length"),
        in_path("patch: 1e99, " + kGood, "a length"),
        in_path("tolerance: 0, " + kGood, "expected a length"),
        in_path("points: 3", "expected a list of points"),
        in_path("points: []", "expected 2 to 31 points"),
        in_path("points: [[0, 1.95, 0]]", "expected 2 to 31 points"),
        in_path(many + "]", "expected 2 to 31 points"),
        in_point("[0, 0]", "expected a list of 3 numbers"),
        in_point("[0, 0, 0, 0]", "expected a list of 3 numbers"),
        in_point("5", "expected a list of 3 numbers"),
        in_point("[0, a, 0]", "found the value 'a', expected a coordinate"),
        in_point("[0, '1', 0]", "found the string '1', expected a coordinate"),
        in_point("[0, .inf, 0]", "expected a coordinate"),
        in_point("[0, 1e30, 0]", "a coordinate"),
        in_point("{x: 0}", "unknown key 'x' in what lies between two points"),
        in_point("{through: 5}", "expected a map that describes an opening"),
        in_point("{through: {corner: [0, 0, 0], u: [1, 0, 0]}}", "found an opening without 'v'"),
        in_point("{through: {corner: [0, 0, 0], u: [1, 0, 0], v: [2, 0, 0]}}", "neither zero nor parallel"),
        in_point("{through: {corner: [0, 0, 0], u: [1, 0, 0], v: [0, 0, 0]}}", "neither zero nor parallel"),
        in_point(kOpening + ", " + kOpening, "expected an opening between two points"),
        in_path("points: [" + kOpening + ", [0, 1.95, 0], [-1, 1, 0.5]]", "expected an opening between two points"),
        in_path("points: [[0, 1.95, 0], [0.6, 0, -0.7], " + kOpening + "]", "expected a point behind the last opening"),
        in_point("{bounces: 1}", "expected an opening behind bounces"),
        in_point("{bounces: 0}, " + kOpening, "a number of bounces"),
        in_point("{bounces: 99}, " + kOpening, "a number of bounces"),
        in_point("{bounces: [2, 1]}, " + kOpening, "the least and the largest number of bounces"),
        in_point("{bounces: [1, 2.5]}, " + kOpening, "the least and the largest number of bounces"),
        in_point("[0.6, 0, -0.7], {bounces: 2}, " + kOpening, "expected bounces behind the first point"),
    };
}

std::vector<Mistake> unusable() {
    const std::string light = "points: [[0, 1.95, 0], ";
    return {
        in_scene("points: [[0.5, 1, 0], [0.6, 0, -0.7]]", "point 1: found the nearest emitter"),
        in_scene(light + "[0.6, 0.5, -0.7]]", "point 2: found it in the air: the surface on the way from point 1"),
        in_scene(light + "[0.5, -0.5, 0.5]]", "point 2: found the segment from point 1 blocked at"),
        in_scene(light + "[-0.7, 0, -0.7]]", "point 2: found the segment from point 1 blocked at"),
        in_scene(light + "[0.6, 0, -0.7], [0.6, 0, -0.7]]", "point 3: found the same place as point 2"),
        in_scene(light + "[0.5, 2, 0.5]]", "point 1: found an emitter that sends no light towards point 2"),
        in_scene(light + "[1, 0.5, 0.2]]", "point 2: found a specular vertex at its end"),
        in_scene(light + "[1, 0.5, 0.2], [0.6, 0, -0.7]]", "point 3: found that the specular vertex at point 2 sends"),
        in_scene("beta: [5, 0], " + light + "[0.6, 0, -0.7], [-1, 1, 0.5]]", "point 3: found a cone of no width"),
        in_scene(light + "[0.6, 0, -0.7], " + kOpening + ", [1, 1.9, -1]]",
                 "point 4: found that the segment from point 2 leads away from its opening"),
        in_scene(light + "[0.6, 0, -0.7], " + kOpening + ", [-1, 1, 0.5]]",
                 "passes beside its opening: it crosses the plane at (-0.06667, 0.4167, -0.2), 0.107 m off"),
        in_scene(light +
                     "[0.6, 0, -0.7], {through: {corner: [0, 0, 1], u: [0.5, 0, 0], v: [0, 0, 0.5]}}, [-1, 1, 0.5]]",
                 "point 4: found that the segment from point 2 begins in the plane of its opening"),
        in_scene(light + "[1, 0.5, 0.2], " + kOpening + ", [-1, 1, 0.5]]",
                 "point 4: found an opening behind the specular"),
        in_scene(light + "{bounces: [1, 3]}, " + kOpening + ", [0.6, 0.5, -0.7]]",
                 "1 bounce', point 4: found it in the air: the surface on the way from the middle of the opening is"),
        in_scene("tolerance: 1e-4, points: [[0, 1.951, 0], [0.6, 0, -0.7]]", "expected one within 0.0001 m"),
        in_scene(light + "[0.6, 0, -0.5], [0, 1.95, 0], [0.6, 0, 0]]", "point 3: found a surface that scatters no"),
    };
}

std::string error_of(const std::string& file, const Scene* scene) {
    try {
        const UserPathFile paths = load_user_paths(file);
        if (scene != nullptr) bind_user_paths(*scene, paths);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

} // namespace

TEST(UserPathFile, EveryMistakeGivesOneClearError) {
    const ScratchDirectory scratch;
    for (const Mistake& mistake : unreadable()) {
        const std::string file = scratch.write("p.yaml", mistake.text), error = error_of(file, nullptr);
        EXPECT_THAT(error, HasSubstr(mistake.message)) << mistake.text;
        EXPECT_THAT(error, StartsWith(file)) << mistake.text;
        EXPECT_EQ(error.find('\n'), std::string::npos) << mistake.text;
    }
    EXPECT_THAT(error_of(scratch.path("none.yaml"), nullptr), HasSubstr("none.yaml"));
}

TEST(UserPathFile, WhatCannotWorkInASceneIsRefusedByPathAndPoint) {
    const ScratchDirectory scratch;
    const auto scene = test::mirror_glass_box();
    for (const Mistake& mistake : unusable()) {
        const std::string file = scratch.write("p.yaml", mistake.text), error = error_of(file, scene.get());
        EXPECT_THAT(error, HasSubstr(mistake.message)) << mistake.text;
        EXPECT_THAT(error, StartsWith(file + ":2:")) << mistake.text;
        EXPECT_THAT(error, testing::ContainsRegex("path 'a(, 1 bounce)?', point ")) << mistake.text;
    }
}

TEST(UserPathFile, DefaultsReachEveryPathAndItsOwnWordsWin) {
    const ScratchDirectory scratch;
    const UserPathFile file = load_user_paths(
        scratch.write("p.yaml", "beta: 10\npatch: 0.2\npaths:\n  - {" + kGood +
                                    "}\n  - {name: b, weight: 3, patch: 0.1, beta: [2, 4], " + kGood + "}\n"));
    ASSERT_EQ(file.paths.size(), 2u);
    EXPECT_EQ(file.paths[0].name, "path 1");
    EXPECT_NEAR(file.paths[0].beta.at(1), 10 * kPi / 180, 1e-12);
    EXPECT_EQ(file.paths[0].patch, 0.2);
    EXPECT_EQ(file.paths[1].weight, 3);
    EXPECT_NEAR(file.paths[1].beta.at(0), 2 * kPi / 180, 1e-12);
    EXPECT_NEAR(file.paths[1].beta.at(1), 4 * kPi / 180, 1e-12);
    EXPECT_EQ(file.paths[1].patch, 0.1);
    EXPECT_EQ(file.paths[1].points.at(2).p, Imath::V3d(-1, 1, 0.5));
}

TEST(UserPathFile, WhatIsWrittenOfStrangeNamesAndOpeningsIsReadAgain) {
    const ScratchDirectory scratch;
    const std::string through = "through: {corner: [0, 0, 0], u: [1, 0, 0], v: [0, 1, 0]}";
    const std::string bounces = "points: [[0, 1.95, 0], {bounces: 1, " + through + "}, [1, 1, 1]]";
    const UserPathFile out = load_user_paths(scratch.write(
        "p.yaml", "paths:\n"
                  "  - {name: \"a\\bb\\n---\\n'c\\x7f\\\\\", " +
                      kGood +
                      "}\n"
                      "  - {name: \"a\\nb\", " +
                      kGood + "}\n  - {name: a b, " + kGood +
                      "}\n"
                      "  - {name: flat, points: [[0, 0, 0], {through: {corner: [0, 0, 0], u: [1.00000001, 1, 0], "
                      "v: [1, 1.00000001, 0]}}, [1, 0, 0]]}\n"
                      // Two entries that look like two numbers of bounces of one.
                      "  - {name: \"x, 1 bounce\", weight: 2, " +
                      bounces +
                      "}\n"
                      "  - {name: \"x, 2 bounces\", weight: 3, points: [[0, 1.95, 0], {bounces: 2, " +
                      through + "}, [2, 1, 1]]}\n"));
    const UserPathFile in = load_user_paths(scratch.write("q.yaml", user_paths_text(out, "again")));
    ASSERT_EQ(in.paths.size(), out.paths.size());
    for (std::size_t i = 0; i < in.paths.size(); ++i) {
        EXPECT_EQ(in.paths[i].name, out.paths[i].name);
        EXPECT_EQ(in.paths[i].weight, out.paths[i].weight);
        EXPECT_EQ(in.paths[i].points.back().p, out.paths[i].points.back().p);
    }
}

TEST(UserPathFile, WhatIsWrittenIsReadAgain) {
    const ScratchDirectory scratch;
    UserPathFile out{{test::user_path("a: \"b\"", {{0, 1.95f, 0}, {0.5f, 0, 0.5f}}, 0.1),
                      test::user_path("0.5", {{0, 1.95f, 0}, {0.5f, 0, 0.5f}, {-1, 1, 0.5f}}, 0.3)}};
    out.paths[1].points[1].through = Opening{{0, 0.5, -0.2}, {0.5, 0, 0}, {0, 0.5, 0}};
    out.paths[1].points.insert(out.paths[1].points.begin() + 1, 2, UserPathPoint{.bounce = true});
    out.paths[1].beta.insert(out.paths[1].beta.begin(), 2, kDefaultBeta);
    out.paths[1].weight = 2.5;
    out.paths[1].patch = 0.25;
    const UserPathFile in = load_user_paths(scratch.write("p.yaml", user_paths_text(out, "two\nlines")));
    ASSERT_EQ(in.paths.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(in.paths[i].name, out.paths[i].name);
        EXPECT_EQ(in.paths[i].weight, out.paths[i].weight);
        EXPECT_EQ(in.paths[i].patch, out.paths[i].patch);
        ASSERT_EQ(in.paths[i].points.size(), out.paths[i].points.size());
        for (std::size_t k = 0; k < in.paths[i].points.size(); ++k) {
            const UserPathPoint &a = in.paths[i].points[k], &b = out.paths[i].points[k];
            EXPECT_EQ(a.bounce, b.bounce);
            EXPECT_EQ(a.through.has_value(), b.through.has_value());
            if (a.through && b.through) {
                EXPECT_LT((a.through->v - b.through->v).length(), 1e-6);
            }
            EXPECT_TRUE(a.bounce || (a.p - b.p).length() < 1e-6);
        }
        ASSERT_EQ(in.paths[i].beta.size(), out.paths[i].beta.size());
        EXPECT_NEAR(in.paths[i].beta.back(), out.paths[i].beta.back(), 1e-3);
    }
}

/// Else what was checked before it was written may fail afterwards.
TEST(UserPathFile, PointsAreWrittenToTheLastDigit) {
    const ScratchDirectory scratch;
    UserPathFile out{{test::user_path("a", {{0.1f, 1 / 3.0f, 0}, {0.7788992f, 1e-6f / 3, 1234.5678f}}, 0.1)}};
    out.paths[0].points[1].through = Opening{{1 / 3.0, 0, 0}, {0, 1 / 7.0, 0}, {0, 0, 1}};
    const UserPathFile in = load_user_paths(scratch.write("p.yaml", user_paths_text(out, "")));
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(in.paths.at(0).points.at(i).p, out.paths[0].points[i].p);
    EXPECT_EQ(in.paths[0].points[1].through->corner, out.paths[0].points[1].through->corner);
}

TEST(UserPaths, PointsSnapToTheSurfacesThatLightMeets) {
    const auto scene = test::mirror_glass_box();
    UserPathSpec spec = test::user_path("a", {{0, 1.97f, 0.01f}, {0.51f, 0.01f, -0.5f}, {-0.98f, 1, 0.5f}}, 0.1);
    const UserPath path = bind_user_path(*scene, spec);
    EXPECT_NEAR(path.patch.center().p.y, 1.95f, 1e-6);
    EXPECT_NEAR(path.vertices.at(0).p.y, 0, 1e-6);
    EXPECT_NEAR(path.vertices.at(1).p.x, -1, 1e-6);
    EXPECT_EQ(path.signature(), "L D D");
    EXPECT_TRUE(path.seen);
}

/// Lamps that emit to all sides: one mesh, six rectangles, a ball. Seen from below their tops are behind them.
std::unique_ptr<Scene> lamps_in_a_room() {
    test::SceneMaker m;
    const test::MaterialPtr white = make_diffuse(Rgb(0.5));
    m.room({-3, 0, -3}, {3, 3, 3}, white);
    for (const Geometry& lamp : {Geometry(make_box({-1.5f, 2.5f, -0.5f}, {-1.4f, 2.58f, 0.5f})),
                                 Geometry(Sphere{{0, 2.54f, 0}, 0.04f, false})}) {
        Shape shape;
        shape.geometry = lamp;
        shape.material = white;
        shape.emission = std::make_unique<SurfaceEmission>(SurfaceEmission{Rgb(1.0), false});
        m.shape(std::move(shape));
    }
    const Vec3 corner(1.4f, 2.5f, -0.5f), u(0.1f, 0, 0), v(0, 0.08f, 0), w(0, 0, 1);
    for (const auto& [a, b, c] : {std::array{u, v, w}, {v, w, u}, {w, u, v}})
        m.rectangle(corner, b, a, white, Rgb(1.0)).rectangle(corner + c, a, b, white, Rgb(1.0));
    return m.camera({0, 1, 2.9f}, {0, 1, 0}, 60).window(16, 16).build();
}

TEST(UserPaths, TheFirstPointMayLieAnywhereInALamp) {
    const auto scene = lamps_in_a_room();
    for (const float x : {-1.45f, 0.0f, 1.45f})
        for (const float y : {2.47f, 2.51f, 2.54f, 2.57f})
            for (const float floor : {x - 1, x, x + 0.4f}) {
                const UserPath path = bind_user_path(*scene, test::user_path("a", {{x, y, 0}, {floor, 0, 0.2f}}, 0.1));
                const SurfacePoint& light = path.patch.center();
                const Vec3 to = (path.vertices[0].p - light.p).normalized();
                EXPECT_GT(luminance(scene->emitter(light.emitter).radiance(light, to)), 0) << x << " " << y;
                EXPECT_NEAR(light.p.x, x, 0.06) << "another lamp";
            }
    // Of places that send light there the nearest.
    const UserPath path = bind_user_path(*scene, test::user_path("a", {{-1.44f, 2.57f, 0.1f}, {3, 1.4f, 0.1f}}, 0.1));
    EXPECT_NEAR(path.patch.center().p.x, -1.4f, 1e-6);
    EXPECT_NEAR(path.patch.center().p.y, 2.57f, 1e-6);
}

TEST(UserPathFile, ARangeOfBouncesBecomesAPathForEachNumber) {
    const ScratchDirectory scratch;
    const UserPathFile file = load_user_paths(
        scratch.write("p.yaml", "paths: [{name: door, weight: 2, points: [[0, 1.95, 0], {bounces: [1, 3]}, " +
                                    kOpening + ", [0.3, 0, 0]]}]"));
    ASSERT_EQ(file.paths.size(), 3u);
    double weight = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(file.paths[i].name, "door, " + std::to_string(i + 1) + (i == 0 ? " bounce" : " bounces"));
        EXPECT_EQ(file.paths[i].points.size(), i + 3);
        weight += file.paths[i].weight;
    }
    EXPECT_NEAR(weight, 2, 1e-9);
    const auto scene = test::diffuse_box();
    EXPECT_EQ(bind_user_path(*scene, file.paths[1]).signature(), "L * * D");
}

TEST(UserPaths, ThoseThatFailTheirCheckCanBeLeftOut) {
    const auto scene = test::diffuse_box();
    UserPathFile file = test::diffuse_box_paths(*scene);
    file.paths.insert(file.paths.begin() + 1,
                      test::user_path("into the air", {{0, 1.95f, 0}, {0.4f, 0.5f, 0.3f}}, 0.9));
    std::vector<std::string> warnings;
    const UserPathFile usable = usable_paths(*scene, file, warnings);
    ASSERT_EQ(usable.paths.size(), 3u);
    EXPECT_EQ(usable.paths[1].name, file.paths[2].name);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_THAT(warnings[0], testing::HasSubstr("'into the air'"));
    EXPECT_THAT(warnings[0], testing::EndsWith("the path is left out"));
}

TEST(UserPaths, EventsAtSpecularVerticesFollowFromThePointAfter) {
    const auto scene = test::mirror_glass_box();
    const UserPaths paths = bind_user_paths(*scene, test::mirror_glass_box_paths(*scene));
    EXPECT_EQ(paths.at(0).signature(), "L S S D");
    EXPECT_EQ(paths[0].vertices[0].event, Event::transmit);
    EXPECT_EQ(paths[0].vertices[1].event, Event::transmit);
    EXPECT_EQ(paths.at(3).vertices[0].event, Event::reflect);
}

TEST(EmitterPatch, SamplesLieInsideWithTheDensityThatIsTold) {
    const auto scene = test::diffuse_box();
    const UserPath path = bind_user_paths(*scene, test::diffuse_box_paths(*scene)).at(0);
    const EmitterPatch patch(*scene, path.patch.center(), 0.03);
    Rng rng(1, StreamPurpose::test, 0);
    for (int i = 0; i < 1000; ++i) {
        const SurfacePoint p = patch.sample(rng);
        EXPECT_LE((p.p - path.patch.center().p).length(), 0.03 * (1 + 1e-5));
        EXPECT_GT(patch.pdf(p), 0) << i;
    }
    // The share of the whole lamp's points that lie inside is its area's share: density times area of the lamp.
    const Emitter& lamp = scene->emitter(path.patch.center().emitter);
    int inside = 0;
    double density = 0;
    constexpr int n = 200'000;
    for (int i = 0; i < n; ++i) {
        SurfacePoint p = lamp.sample_point(rng).point;
        p.emitter = path.patch.center().emitter;
        if (const double d = patch.pdf(p); d > 0) ++inside, density = d;
    }
    ASSERT_GT(inside, 0);
    const double expected = lamp.point_pdf(path.patch.center()) / density;
    EXPECT_NEAR(static_cast<double>(inside) / n, expected, 5 * std::sqrt(expected / n));
}

TEST(EmitterPatch, OnASphereIsTheCapThatItSamplesHoweverSmall) {
    SceneDescription d;
    d.shapes.resize(1);
    d.shapes[0].geometry = Sphere{};
    d.shapes[0].material = make_black();
    d.shapes[0].emission = std::make_unique<SurfaceEmission>(SurfaceEmission{Rgb(1.0)});
    const Scene scene(std::move(d));
    Rng rng(1, StreamPurpose::test, 0);
    const SurfacePoint center = scene.emitter(0).sample_point(rng).point;
    for (const double radius : {0.1, 1e-3, 3e-4}) {
        const EmitterPatch patch(scene, center, radius), around(scene, center, 3 * radius);
        int inside = 0, own = 0;
        constexpr int n = 20'000;
        for (int i = 0; i < n; ++i) {
            own += patch.pdf(patch.sample(rng)) > 0 ? 1 : 0;
            inside += patch.pdf(around.sample(rng)) > 0 ? 1 : 0;
        }
        EXPECT_GT(own, 0.998 * n) << "but for rounding at the rim, radius " << radius;
        EXPECT_NEAR(inside / static_cast<double>(n), 1.0 / 9, 0.01) << radius;
    }
}

} // namespace keyhole
