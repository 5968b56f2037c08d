// Metropolis photon sampling and path tracing make the same picture.
#include "methods/method.h"
#include "scene/load/load.h"
#include "support/agreement.h"
#include "support/chance.h"
#include "support/settings_from.h"

#include <gtest/gtest.h>

#include <iostream>

namespace keyhole {
namespace {

struct MpsCase {
    const char* scene;
    int noisy = 0; ///< blocks of which nothing can be told
};

void PrintTo(const MpsCase& c, std::ostream* out) { *out << c.scene; }

class Mps_AgreesWithPathTracing : public testing::TestWithParam<MpsCase> {};

TEST_P(Mps_AgreesWithPathTracing, BlockByBlock) {
    Scene scene(load_scene(std::string(KEYHOLE_SOURCE_DIR "/scenes/") + GetParam().scene + ".yaml").description);
    scene.set_window({96, 64, 0});
    Settings paths; // from both ends: through a door those from the eye alone would be noise
    paths.method = &methods::bdpt;
    paths.spp = 5;
    paths.seed = 1000;
    Settings mps = test::settings_from("method=mps spp=4 brightness_samples=40k brightness_error=0 importons=60k "
                                       "mutations=120k photons=40k cache_rays=200");
    const test::Blocks reference = test::render_blocks(scene, paths, 10);
    const test::Disagreement d = test::compare(test::render_blocks(scene, mps, 4), reference, 0.03);
    std::cout << "quiet ratio " << d.quiet_ratio << ", whole " << d.ratio << ", noisy " << d.noisy << "\n";
    EXPECT_EQ(d.rejected, 0) << d.report << "mean brightness ratio " << d.ratio;
    EXPECT_NEAR(d.quiet_ratio, 1, 0.05) << "whole picture " << d.ratio;
    EXPECT_LE(d.noisy, GetParam().noisy) << "the test couldn't see a difference; largest error " << d.largest_error;
}

// Where the lamp of the lantern is seen, its light through the glass has a heavy tail: now and then one sample is as
// bright as the whole picture, and the block of it says nothing.
INSTANTIATE_TEST_SUITE_P(Scenes, Mps_AgreesWithPathTracing,
                         testing::Values(MpsCase{"box"}, MpsCase{"rooms"}, MpsCase{"lantern", 1}),
                         [](const auto& info) { return std::string(info.param.scene); });

TEST(StudentPValue, AgreesWithTables) {
    EXPECT_NEAR(test::student_p_value(2.228, 10), 0.05, 1e-4);
    EXPECT_NEAR(test::student_p_value(-3.169, 10), 0.01, 1e-4);
    EXPECT_NEAR(test::student_p_value(1.960, 1e6), 0.05, 1e-4);
    EXPECT_NEAR(test::student_p_value(0, 3), 1, 1e-12);
}

} // namespace
} // namespace keyhole
