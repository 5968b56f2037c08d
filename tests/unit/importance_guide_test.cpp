// What guides light tracing: when it gives up, and when it isn't worth its time.
#include "photonmap/importance/importance_map.h"

#include "photon_support.h"
#include "photonmap/emission.h"
#include "photonmap/importance/importance_tracing.h"
#include "sampling/paths/walk.h"
#include "scene/emitters/emitters.h"
#include "scene/ray_counter.h"
#include "scene/scene.h"
#include "support/test_scenes.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using namespace photon_test;

/// A board lies low above a floor, and all importons on the board: from the floor each of them is hidden.
TEST(ImportanceGuide, GivesUpWhereImportonsAreHidden) {
    constexpr float kReach = 0.5f;
    const Rectangle floor{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}}, board{{0, 0.05f, 0}, {0, 0, 1}, {1, 0, 0}};
    const MaterialPtr white = make_diffuse(Rgb(0.5));
    SceneDescription d;
    for (const Rectangle& r : {floor, board}) {
        d.shapes.push_back(shape_of(r));
        d.shapes.back().material = white;
    }
    const Scene scene(std::move(d));
    const SurfacePatches patches(scene);
    Rng rng = make_rng(11);
    const ImportanceGuide guide(PhotonMap(throw_photons(board, 4000, rng)), kReach, patches, &scene, {});
    const auto looked_up_from = [&](float height) {
        SurfacePoint above;
        above.site = Site::point;
        above.p = Vec3(0.5f, height, 0.5f);
        const Vertex v = next_vertex(scene, above, Vec3(0, -1, 0)).value();
        const std::uint64_t before = rays_traced();
        const bool known = guide.visible_power(v, Vec3(0, 1, 0), Rgb(1.0)).has_value();
        return std::pair(known, rays_traced() - before);
    };
    EXPECT_TRUE(looked_up_from(0.1f).first);
    const auto [known, rays] = looked_up_from(0.04f);
    EXPECT_FALSE(known);
    EXPECT_GT(rays, 2) << "nothing was tested";
    EXPECT_LT(rays, 10);
}

double share_seen(const Scene& scene) {
    const SurfacePatches patches(scene);
    Importons importons = trace_importance(scene, {.samples = 30'000, .max_scatterings = 8, .seed = 1}, {});
    const ImportanceGuide at_d1(PhotonMap(std::move(importons.first)), 0.3f, patches, &scene, {});
    const ImportanceGuide at_d2(PhotonMap(std::move(importons.second)), 0.3f, patches, &scene, {});
    return share_of_photons_seen(scene, {&at_d2, &at_d1}, {.max_scatterings = 8}, 8192, 2, {});
}

/// In a box that is in view as a whole nearly every photon counts; of the light of a room behind a slit little does,
/// and of the sky's, most of which misses the window, though what comes in is all seen.
TEST(ShareOfPhotonsSeen, TellsWhereImportanceIsWorthIt) {
    EXPECT_GT(share_seen(*test::diffuse_box()), 0.6);
    EXPECT_LT(share_seen(*test::two_rooms(0.1f)), 0.1);
    test::SceneMaker room = test::room_with_a_window();
    room.emitter(make_constant_environment(Rgb(1.0))).camera({2.7f, 1.5f, 2.8f}, {0.8f, 0.7f, 0.4f}, 55).window(48, 32);
    EXPECT_LT(share_seen(*room.build()), 0.2);
}

} // namespace
} // namespace keyhole
