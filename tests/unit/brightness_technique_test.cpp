// Which technique stage one chooses.
#include "sampling/brightness.h"
#include "scene/load/load.h"
#include "support/scratch_directory.h"

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
        right += measure("  - {type: rectangle, material: {type: mirror}, corner: [-0.999, -0.1, -0.999], "
                         "u: [1.998, 0, 0], v: [0, 0.1, 0]}\n",
                         5000, seed)
                             .technique == Technique::bidirectional
                     ? 1
                     : 0;
    EXPECT_GE(right, 14);
}

TEST(StageOneTechnique, IsTheCheaperOneWhereBothFindTheLight) { EXPECT_EQ(measure("").technique, Technique::path); }

} // namespace
} // namespace keyhole
