// How lobes are asked where gather rays end: by the technique that is less noisy there.
#include "gather/lobe_techniques.h"

#include "core/statistics.h"
#include "mapped_gather.h"
#include "photonmap/emission.h"
#include "scene/emitters/emitters.h"
#include "support/chance.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

constexpr float kReach = 0.2f; // of lookups [m]
constexpr std::int64_t kPaths = 20'000;

/// Gather rays that ask the photons of light paths.
MappedGather gather(const Scene& scene, const SurfacePatches& patches, std::uint64_t seed) {
    const EmissionOptions options{.paths = kPaths, .photons = kPaths, .seed = seed};
    return {
        scene, patches, emit_photons(scene, {}, options, {}).global, {.max_radius = kReach, .caustic_radius = kReach}};
}

LobeTechniques techniques(const Scene& scene) {
    const SurfacePatches patches(scene);
    return {gather(scene, patches, 1).rays(), 1, {}};
}

/// A window of ground glass before an even sky. The faces of the glass are the last two shapes.
std::unique_ptr<Scene> frosted_window() {
    test::SceneMaker m = test::room_with_a_window();
    test::add_pane(m, test::ground_glass());
    m.emitter(make_constant_environment(Rgb(1.0)));
    return m.camera({2.7f, 1.5f, 2.8f}, {0.8f, 1.0f, 0.2f}, 60).window(16, 16).build();
}

/// A bulb of ground glass with a lamp in it that is so wide [m], the last shape but that.
std::unique_ptr<Scene> frosted_bulb(float width) {
    test::SceneMaker m;
    const Vec3 bulb(1.2f, 1.2f, 1.2f);
    m.room({0, 0, 0}, {2.5f, 2.5f, 2.5f}, make_diffuse(Rgb(0.6)));
    m.sphere(bulb, 0.25f, test::ground_glass());
    m.rectangle(bulb - Vec3(width / 2, 0, width / 2), {0, 0, width}, {width, 0, 0}, make_diffuse(Rgb(0.0)), Rgb(100.0),
                true);
    return m.camera({2.4f, 2.4f, 2.4f}, {0.8f, 0.7f, 0.4f}, 60).window(16, 16).build();
}

std::uint32_t last_shape(const Scene& scene, std::uint32_t but = 0) {
    return static_cast<std::uint32_t>(scene.shapes().size()) - 1 - but;
}

TEST(LobeTechniques, TraceOnThroughWindowsBeforeAnEvenSky) {
    const auto scene = frosted_window();
    EXPECT_FALSE(techniques(*scene).by_photons(last_shape(*scene)));
}

TEST(LobeTechniques, AskPhotonsOfASmallLampInGroundGlass) {
    const auto scene = frosted_bulb(0.02f);
    EXPECT_TRUE(techniques(*scene).by_photons(last_shape(*scene, 1)));
}

// A photon errs for all the samples around, a ray for its own: photons have the smaller variance here.
TEST(LobeTechniques, TraceOnToALargeLampBehindAWindow) {
    test::SceneMaker m = test::room_with_a_window();
    test::add_pane(m, test::ground_glass());
    m.rectangle({0.9f, 0.9f, -1}, {1, 0, 0}, {0, 1, 0}, make_diffuse(Rgb(0.0)), Rgb(10.0));
    const auto scene = m.camera({2.7f, 1.5f, 2.8f}, {0.8f, 1.0f, 0.2f}, 60).window(16, 16).build();
    EXPECT_FALSE(techniques(*scene).by_photons(last_shape(*scene, 1)));
}

/// What rays from a place in the room to the glass find in many maps.
struct Found {
    RunningStats by_photons, traced, noise; ///< the noise: what is said of that by photons
};
Found look(const Scene& scene, const Vec3& place, const Vec3& glass, std::uint64_t maps) {
    const SurfacePatches patches(scene);
    const Vec3 w = (glass - place).normalized();
    SurfacePoint eye;
    eye.site = Site::point;
    eye.p = place;
    const Vertex met = make_vertex(*scene.trace(eye, w));
    const LobeTechniques always_traced;
    Found found;
    for (std::uint64_t seed = 1; seed <= maps; ++seed) {
        const MappedGather of_map = gather(scene, patches, seed);
        Rng rng(seed, StreamPurpose::test, 0);
        RunningStats one, other; // of one map
        for (int i = 0; i < 50; ++i) {
            one.add(luminance(of_map.along(place, w, rng).indirect));
            other.add(luminance(of_map.along(place, w, rng, &always_traced).indirect));
        }
        found.by_photons.add(one.mean());
        found.traced.add(other.mean());
        if (const auto n = of_map.rays().lobe_noise(met, -w, 1, rng)) found.noise.add(n->photons + n->direct);
    }
    return found;
}

TEST(LobeTechniques, BringTheSameLight) {
    const Found window = look(*frosted_window(), {1.5f, 1.2f, 1.5f}, {1.3f, 1.4f, 0}, 60);
    EXPECT_TRUE(test::same_mean(window.by_photons, window.traced));
    // All light of the glass is that of photons.
    EXPECT_NEAR(window.noise.mean(), window.by_photons.variance(), 0.6 * window.by_photons.variance());

    const Found bulb = look(*frosted_bulb(0.3f), {1.3f, 2.2f, 1.2f}, {1.2f, 1.2f, 1.2f}, 15);
    EXPECT_TRUE(test::same_mean(bulb.by_photons, bulb.traced));
}

} // namespace
} // namespace keyhole
