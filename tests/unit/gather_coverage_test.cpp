// The reach of gather rays, and that every path is stored once whatever it is.
#include "methods/method.h"
#include "methods/photons/find_coverage.h"
#include "sampling/brightness.h"
#include "scene/ray_counter.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr int kDepth = 8;

/// Adds up a sample of stage one, and checks what it says of its paths.
struct KindSink {
    const PathSet& set;
    double all = 0, caustic = 0;
    int wrong = 0;

    void contribution(const Rgb& value, PhotonKind kind, auto&& make_path) {
        all += luminance(value);
        if (kind == PhotonKind::caustic) caustic += luminance(value);
        Path path = make_path();
        if (set.find_storage(path).kind != kind) ++wrong;
    }
};

/// In test::two_rooms() the eye is where z > 0, the lamp beyond the partition.
constexpr Vec3 kUp(0, 1, 0), kBack(0, 0, -1), kFront(0, 0, 1);

TEST(GatherCoverage, EndsBehindANarrowSlit) {
    const auto scene = test::two_rooms(0.01f);
    const GatherCoverage coverage(*scene, kDepth);
    for (const float x : {-1.5f, 0.0f, 1.5f}) {
        EXPECT_TRUE(coverage.comes_to({x, 0, 2}, kUp)) << x;
        EXPECT_FALSE(coverage.comes_to({x, 0, -2}, kUp)) << x;
        EXPECT_FALSE(coverage.comes_to({x, 1, -4}, kFront)) << x;
    }
    EXPECT_TRUE(coverage.comes_to({-1, 1, 4}, kBack)); // behind the eye
    EXPECT_GT(light_outside_coverage(*scene, coverage, kDepth), 0.5);
}

TEST(GatherCoverage, KnowsTheSidesOfAThinWall) {
    const auto scene = test::two_rooms(0.01f);
    const GatherCoverage coverage(*scene, kDepth);
    EXPECT_TRUE(coverage.comes_to({0, 1, 0}, kFront));
    EXPECT_FALSE(coverage.comes_to({0, 1, 0}, kBack)); // the hollow of the partition
    EXPECT_FALSE(coverage.comes_to({0, 1, -0.1f}, kBack));
}

TEST(GatherCoverage, EndsAtAWallWithoutThickness) {
    const auto scene = test::two_rooms(0.01f, true);
    constexpr float kWall = -0.0625f, kSlit = 1.2f;
    for (const std::int64_t paths : {1 << 12, 1 << 16}) { // few paths make coarse cells
        const GatherCoverage coverage(*scene, kDepth, paths);
        int missed = 0, beyond = 0;
        for (float x = -1.9f; x < 1.95f; x += 0.1f)
            for (const float distance : {0.03f, 0.1f, 0.3f}) {
                if (std::abs(x - kSlit) < 0.3f) continue;
                missed += coverage.comes_to({x, 0, kWall + distance}, kUp) ? 0 : 1;
                beyond += coverage.comes_to({x, 0, kWall - distance}, kUp) ? 1 : 0;
            }
        EXPECT_LE(missed, 5) << paths;
        EXPECT_EQ(beyond, 0) << paths;
    }
}

TEST(GatherCoverage, IsEverywhereInARoom) {
    const auto scene = test::diffuse_box();
    const GatherCoverage coverage(*scene, kDepth);
    EXPECT_LT(light_outside_coverage(*scene, coverage, kDepth), 0.01);
    EXPECT_FALSE(find_coverage(*scene, {}).coverage.has_value());
}

TEST(GatherCoverage, IsSoughtWhereAFinalGatherWouldBeNoise) {
    Settings off;
    off.gather_coverage = false;
    for (const float width : {0.01f, 0.003f})
        for (const std::int64_t importons : {10'000, 100'000, 400'000}) {
            Settings s;
            s.importons = importons;
            EXPECT_TRUE(find_coverage(*test::two_rooms(width), s).coverage.has_value()) << width << " m, " << importons;
        }
    EXPECT_FALSE(find_coverage(*test::two_rooms(2), {}).coverage.has_value());
    EXPECT_FALSE(find_coverage(*test::two_rooms(0.01f), off).coverage.has_value());
    Settings standard;
    standard.method = &methods::pm;
    EXPECT_FALSE(find_coverage(*test::two_rooms(0.01f), standard).coverage.has_value());
}

// Few rays meet the globe of a lamp, and none its inside, where the light comes to it; but records aim at it.
TEST(GatherCoverage, IsNotSoughtForALampInAGlobe) {
    const Vec3 lamp(1.5f, 2.4f, 6);
    const auto half = constant_texture(Rgb(0.5));
    test::SceneMaker m;
    const auto scene = m.room({0, 0, 0}, {3, 3, 9}, make_diffuse(Rgb(0.6)))
                           .rectangle(lamp, {0.03f, 0, 0}, {0, 0, 0.03f}, make_diffuse(Rgb(0.0)), Rgb(2000.0), true)
                           .sphere(lamp, 0.12f, make_diffuse_transmission(half, half))
                           .camera({1.5f, 1.5f, 0.3f}, {1.5f, 1.2f, 9}, 70)
                           .window(64, 64)
                           .build();
    EXPECT_FALSE(find_coverage(*scene, {}).coverage.has_value());
}

TEST(GatherCoverage, ComesToBothSidesOfACurtain) {
    test::SceneMaker m;
    const auto half = constant_texture(Rgb(0.5));
    const auto scene = m.room({0, 0, 0}, {3, 3, 6}, make_diffuse(Rgb(0.6)))
                           .rectangle({0, 0, 2}, {3, 0, 0}, {0, 3, 0}, make_diffuse_transmission(half, half))
                           .camera({1.5f, 1.5f, 5.7f}, {1.5f, 1.2f, 2}, 70)
                           .window(64, 64)
                           .build();
    const GatherCoverage coverage(*scene, kDepth);
    for (const float z : {1.0f, -1.0f}) EXPECT_TRUE(coverage.comes_to({1.5f, 1, 2}, {0, 0, z}));
}

TEST(GatherCoverage, SplitsPathsAndLosesNone) {
    const auto scene = test::two_rooms(0.3f);
    const GatherCoverage coverage(*scene, kDepth);
    const PathSet everywhere, within{.coverage = &coverage};
    const StageOneSettings settings{.set = PathSet::all, .max_scatterings = kDepth, .samples = 20'000, .seed = 5};
    const StageOne stage = run_stage_one(*scene, settings, {});
    int moved = 0, kept = 0;
    for (Path path : choose_seeds(*scene, settings, stage, stage.all_groups(), 2000)) {
        const int d1 = nth_finite_from_eye(path, 1), d2 = nth_finite_from_eye(path, 2);
        const StoragePoint before = everywhere.find_storage(path), now = within.find_storage(path);
        const std::uint64_t rays = rays_traced();
        const StoragePoint again = within.find_storage(path);
        EXPECT_EQ(again.kind, now.kind);
        EXPECT_EQ(rays_traced(), rays) << "d2 knows";
        if (d2 == 0) { // direct light
            EXPECT_EQ(now.kind, before.kind);
            continue;
        }
        const auto at = static_cast<std::size_t>(d2);
        const Vec3 to_light = direction(path.x[at].point, path.x[at - 1].point);
        if (coverage.comes_to(path.x[at].point.p, facing(path.x[at].point.ng, to_light))) {
            EXPECT_EQ(now.kind, before.kind);
            EXPECT_EQ(now.vertex, before.vertex);
            ++kept;
        } else {
            EXPECT_EQ(now.kind, PhotonKind::caustic);
            EXPECT_EQ(now.vertex, d1);
            ++moved;
        }
    }
    EXPECT_GT(moved, 100);
    EXPECT_GT(kept, 100);
}

TEST(GatherCoverage, BrightnessIsThatOfThePathsThatAreStored) {
    const auto scene = test::two_rooms(0.3f);
    const GatherCoverage coverage(*scene, kDepth);
    const auto measure = [&](const PathSet& set, Technique technique) {
        KindSink sink{set};
        RunningStats all, caustic;
        for (std::uint64_t i = 0; i < 40'000; ++i) {
            Rng rng(9, StreamPurpose::test, i);
            const float x = static_cast<float>(rng.next()), y = static_cast<float>(rng.next());
            sink.all = sink.caustic = 0;
            trace_independent(technique, *scene, {x, y}, {kDepth, set}, rng, sink);
            all.add(sink.all);
            caustic.add(sink.caustic);
        }
        EXPECT_EQ(sink.wrong, 0);
        return std::array{all, caustic};
    };
    const PathSet within{.coverage = &coverage};
    const auto path = measure(within, Technique::path), both = measure(within, Technique::bidirectional);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_GT(path[k].mean(), 0);
        EXPECT_TRUE(test::same_mean(path[k], both[k], 2));
    }
}

} // namespace
} // namespace keyhole
