// Metropolis photon sampling and path tracing make the same picture.
#include "scene/load/scene_yaml.h"
#include "support/agreement.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

class Mps_AgreesWithPathTracing : public testing::TestWithParam<const char*> {};

TEST_P(Mps_AgreesWithPathTracing, BlockByBlock) {
    Scene scene(load_scene(std::string(KEYHOLE_SOURCE_DIR "/scenes/") + GetParam() + ".yaml").description);
    scene.set_window({96, 64, 0});
    Settings paths; // from both ends: through a door those from the eye alone would be noise
    paths.method = "bdpt";
    paths.spp = 24;
    paths.seed = 1000;
    Settings mps;
    mps.method = "mps";
    mps.spp = 4;
    mps.brightness_samples = 200'000;
    mps.importons = 200'000;
    mps.mutations = 300'000;
    mps.photons = 60'000;
    const test::Blocks reference = test::render_blocks(scene, paths, 4);
    const test::Disagreement d = test::compare(test::render_blocks(scene, mps, 4), reference, 0.03);
    RecordProperty("ratio", std::to_string(d.ratio));
    RecordProperty("largest_error", std::to_string(d.largest_error));
    EXPECT_EQ(d.rejected, 0) << d.report << "mean brightness ratio " << d.ratio;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Mps_AgreesWithPathTracing, testing::Values("box", "rooms", "lantern"),
                         [](const auto& info) { return std::string(info.param); });

TEST(StudentPValue, AgreesWithTables) {
    EXPECT_NEAR(test::student_p_value(2.228, 10), 0.05, 1e-4);
    EXPECT_NEAR(test::student_p_value(-3.169, 10), 0.01, 1e-4);
    EXPECT_NEAR(test::student_p_value(1.960, 1e6), 0.05, 1e-4);
    EXPECT_NEAR(test::student_p_value(0, 3), 1, 1e-12);
}

} // namespace
} // namespace keyhole
