// Metropolis light transport and path tracing make the same picture.
#include "methods/method.h"
#include "sampling/proposals/registry.h"
#include "scene/load/load.h"
#include "support/agreement.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"
#include "support/user_paths.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr int kRuns = 8;

std::unique_ptr<Scene> rooms_low() {
    return std::make_unique<Scene>(load_scene(KEYHOLE_SOURCE_DIR "/tests/data/rooms_low/rooms.yaml").description);
}

struct MltCase {
    const char* name;
    std::unique_ptr<Scene> (*make)();
    int path_spp;
    double tolerance; ///< relative; what path tracing misses of a caustic, or has not seen yet
    UserPathFile (*user_paths)(const Scene&) = nullptr; ///< then half of all proposals go along them
};

class Mlt_AgreesWithPathTracing : public testing::TestWithParam<MltCase> {};

TEST_P(Mlt_AgreesWithPathTracing, BlockByBlock) {
    const auto scene = GetParam().make();
    scene->set_window({96, 64, 0});
    Settings path;
    path.method = &methods::path;
    path.spp = GetParam().path_spp;
    path.seed = 1000;
    Settings mlt = test::settings_from("method=mlt spp=2 brightness_samples=12k chains=100 mutations=30k");
    UserPathFile user_paths;
    if (GetParam().user_paths != nullptr) {
        user_paths = GetParam().user_paths(*scene);
        mlt.proposals[proposals::user_path.weight] = 1;
        // Of mirrors seen in mirrors 25,000 find so little that eight runs agree on too little of it by chance.
        mlt.brightness_samples = 60'000;
        mlt.brightness_error = 0; // or stage one takes most of the time
        double others = 0;
        for (const ProposalKind* kind : proposal_kinds())
            if (!kind->needs_user_paths) others += mlt.proposals[kind->weight];
        for (const ProposalKind* kind : proposal_kinds())
            if (!kind->needs_user_paths) mlt.proposals[kind->weight] /= others;
    }
    const test::Blocks reference = test::render_blocks(*scene, path, kRuns);
    const test::Disagreement d =
        test::compare(test::render_blocks(*scene, mlt, kRuns, "beauty", user_paths), reference, GetParam().tolerance);
    RecordProperty("ratio", std::to_string(d.ratio));
    EXPECT_EQ(d.rejected, 0) << d.report << "mean brightness ratio " << d.ratio;
    EXPECT_LT(d.largest_error, 0.5) << "the test couldn't see a difference";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Mlt_AgreesWithPathTracing,
                         testing::Values(MltCase{"DiffuseBox", test::diffuse_box, 10, 0.01},
                                         MltCase{"MirrorGlassBox", [] { return test::mirror_glass_box(); }, 40, 0.01},
                                         MltCase{"ThinLens", [] { return test::mirror_glass_box(0.1f); }, 10, 0.01},
                                         MltCase{"TwoRooms", [] { return test::two_rooms(0.5f); }, 10, 0.01},
                                         MltCase{"Haze", test::hazy_box, 10, 0.01},
                                         MltCase{"Sky", test::sky_box, 10, 0.01},
                                         MltCase{"RoomsLow", rooms_low, 10, 0.01},
                                         MltCase{"GuidedMirrorGlassBox", [] { return test::mirror_glass_box(); }, 40,
                                                 0.01, test::mirror_glass_box_paths},
                                         MltCase{"GuidedTwoRooms", [] { return test::two_rooms(0.5f); }, 10, 0.01,
                                                 [](const Scene& s) { return test::two_rooms_paths(s, 0.5f); }}),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace
} // namespace keyhole
