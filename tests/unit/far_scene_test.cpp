// Scenes far from the origin and scenes with something immense in them: what photons find near by stays near by.
#include "gather/direct_irradiance_cache.h"
#include "methods/method.h"
#include "methods/render.h"
#include "scene/emitters/emitters.h"
#include "scene/warp.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// A closed room of 3 m whose walls follow no axis, a lamp under its ceiling.
std::unique_ptr<Scene> slanted_room(const Vec3& at) {
    test::SceneMaker m;
    const Frame frame(Vec3(0.3f, 0.9f, 0.2f).normalized());
    const Vec3 x = frame.s * 3.0f, y = frame.n * 3.0f, z = frame.t * 3.0f;
    const auto white = make_diffuse(Rgb(0.6));
    for (const auto& [u, v, w] : {std::array{x, y, z}, std::array{y, z, x}, std::array{z, x, y}})
        m.rectangle(at, u, v, white).rectangle(at + w, v, u, white);
    const Vec3 middle = at + (x + y + z) * 0.5f, lamp = middle + y * 0.48f - (x + z) * 0.15f;
    m.rectangle(lamp, x * 0.3f, z * 0.3f, make_diffuse(Rgb(0.0)), Rgb(5.0), true);
    m.camera(middle - z * 0.4f - x * 0.3f, middle, 70).window(24, 16);
    return m.build();
}

double mean_indirect(Scene& scene) {
    Settings s = test::settings_from("method=pm spp=8 light_paths=100k cache_rays=128");
    double sum = 0;
    const RenderResult result = render(scene, s, {});
    for (const float y : result.picture.layers.at("indirect").data) sum += static_cast<double>(y);
    return sum;
}

TEST(FarScene, HasItsIndirectLight) {
    const double here = mean_indirect(*slanted_room(Vec3(0)));
    for (const float distance : {1e3f, 1e4f})
        EXPECT_NEAR(mean_indirect(*slanted_room(Vec3(1, 0.7f, -0.9f) * distance)), here, 0.03 * here) << distance;
}

TEST(ImmenseGround, LendsNoLightToWhatLiesBelowATable) {
    test::SceneMaker m;
    const auto grey = make_diffuse(Rgb(0.5));
    m.rectangle({-1e5f, 0, -1e5f}, {0, 0, 2e5f}, {2e5f, 0, 0}, grey); // faces up; below it nothing but the sky
    m.room({-1, 0.1f, -1}, {1, 1.1f, 1}, grey);
    m.emitter(make_constant_environment(Rgb(1.0)));
    const auto scene = m.build();
    // In the closed room no light of the sky arrives, wherever it is asked about.
    std::vector<Photon> places;
    for (float x = -0.9f; x < 1; x += 0.1f) {
        places.emplace_back(Vec3(x, 0.1f, 0.3f), Vec3(0, 1, 0), Vec3(0, 1, 0), Rgb(1.0));
        places.emplace_back(Vec3(x, 1.1f, 0.3f), Vec3(0, -1, 0), Vec3(0, -1, 0), Rgb(1.0));
    }
    const DirectIrradianceCache cache(*scene, places, kMostFaces, 1, {});
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        const auto direct = cache.direct(i, places[i].position());
        ASSERT_TRUE(direct) << "its surface was not found";
        EXPECT_EQ(direct->y, 0) << places[i].position();
    }
}

TEST(NarrowCone, HoldsTheDirectionsThatAreDrawnInIt) {
    Rng rng(1, StreamPurpose::test, 0);
    for (const double half_angle : {0.1, 0.01, 0.001}) {
        const double cosine = std::cos(half_angle);
        int outside = 0;
        for (int i = 0; i < 100'000; ++i) {
            const auto [u0, u1, u2, u3] = rng.take<4>();
            const Vec3 axis = uniform_sphere(u0, u1);
            if (!in_cone(Frame(axis).to_world(uniform_cone(u2, u3, cosine)), axis, cosine)) ++outside;
        }
        EXPECT_LT(outside, 50) << half_angle;
    }
}

} // namespace
} // namespace keyhole
