// Which technique stage one chooses.
#include "sampling/brightness.h"
#include "scene/load/load.h"
#include "support/chance.h"
#include "support/scratch_directory.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// A closed white room with a lamp of 2 mm under its ceiling, and `more` in it.
StageOne measure(const std::string& more, std::int64_t samples = 40'000, std::uint64_t seed = 1) {
    const ScratchDirectory directory;
    const Scene scene(
        load_scene(directory.write("s.yaml", "film: {resolution: [32, 32]}\n"
                                             "camera: {from: [0, 0, 0.9], to: [0, -0.4, 0], fov: 70}\n"
                                             "materials: {white: {type: diffuse}, glass: {type: glass}}\n"
                                             "shapes:\n"
                                             "  - {type: box, material: white}\n"
                                             "  - {type: rectangle, corner: [0, 0.99, 0], u: [0.002, 0, 0], "
                                             "v: [0, 0, 0.002], emission: {power: 10}}\n" +
                                                 more))
            .description);
    return run_stage_one(scene, {.samples = samples, .seed = seed}, {});
}

/// Behind glass no eye path meets the lamp but by luck, so that a trial finds little light, and that without noise.
TEST(StageOneTechnique, IsNotTheOneThatMissesTheLight) {
    const StageOne behind_glass =
        measure("  - {type: box, material: glass, min: [-0.999, 0.8, -0.999], max: [0.999, 0.9, 0.999]}\n");
    EXPECT_EQ(behind_glass.technique, Technique::bidirectional);
    EXPECT_GT(behind_glass.caustic.mean(), 10 * behind_glass.caustic.standard_error());
}

/// A part of the light, and few samples: what path tracing misses is not four standard errors of either.
TEST(StageOneTechnique, IsSeldomTheOneThatMissesAPartOfTheLight) {
    int right = 0;
    for (std::uint64_t seed = 1; seed <= 16; ++seed)
        right += measure("  - {type: sphere, material: {type: mirror}, center: [0.4, -0.5, -0.4], radius: 0.45}\n",
                         5000, seed)
                             .technique == Technique::bidirectional
                     ? 1
                     : 0;
    EXPECT_GE(right, 14);
}

TEST(StageOneTechnique, IsTheCheaperOneWhereBothFindTheLight) { EXPECT_EQ(measure("").technique, Technique::path); }

/// Adds up what bidirectional tracing finds by itself.
struct Plain {
    double all = 0, caustic = 0;
    void contribution(const Rgb& value, PhotonKind kind, auto&& /*make_path*/) {
        all += luminance(value);
        if (kind == PhotonKind::caustic) caustic += luminance(value);
    }
};

/// Light paths that meet the eye by way of flat mirrors share what bidirectional tracing finds, and add nothing.
TEST(StageOneMirrors, LeaveBrightnessWhatItIs) {
    const auto scene = test::mirror_corner_box();
    const StageOne found = run_stage_one(*scene, {.max_scatterings = 8, .samples = 200'000}, {});
    EXPECT_EQ(found.technique, Technique::bidirectional);
    RunningStats all, caustic;
    for (std::uint64_t i = 0; i < 200'000; ++i) {
        Rng rng(7, StreamPurpose::test, i);
        const Vec2 image(static_cast<float>(rng.next()), static_cast<float>(rng.next()));
        Plain plain;
        trace_independent(Technique::bidirectional, *scene, image, {8, PathSet::stored}, rng, plain);
        all.add(plain.all);
        caustic.add(plain.caustic);
    }
    EXPECT_LT(caustic.standard_error(), 0.02 * caustic.mean());
    EXPECT_TRUE(test::same_mean(found.brightness, all, 2));
    EXPECT_TRUE(test::same_mean(found.caustic, caustic, 2));
}

/// What a mirror ball throws on the walls is seen in a mirror as well, where no light path is joined to the lens but by
/// way of it. From the eye one path in a hundred thousand finds so small a lamp.
TEST(StageOneMirrors, TellTheBrightnessOfCausticsSeenInThem) {
    const std::string ball = "  - {type: sphere, material: {type: mirror}, center: [0.3, -0.4, -0.3], radius: 0.3}\n";
    const std::string mirror = "  - {type: rectangle, material: {type: mirror}, corner: [-0.999, -0.999, -0.999], "
                               "u: [0, 1.9, 0], v: [0, 0, 1.9]}\n";
    const StageOne found = measure(ball + mirror);
    EXPECT_GT(found.caustic.mean(), 0);
    EXPECT_LT(found.caustic.standard_error(), 0.05 * found.caustic.mean());
}

} // namespace
} // namespace keyhole
