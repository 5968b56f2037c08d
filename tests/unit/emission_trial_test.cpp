// What paths from the eye can't learn of light, and what is made of it.
#include "methods/photons/trials/trials.h"

#include "core/statistics.h"
#include "photonmap/importance/importance_tracing.h"
#include "sampling/guidance/learned/look_for_light.h"
#include "scene/emitters/emitters.h"
#include "support/test_scenes.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

#include <numeric>

namespace keyhole {
namespace {

struct TriedEmission {
    LearnedEmission learned;
    EmissionTrial trial;
    double hidden() const { return std::accumulate(trial.hidden.begin(), trial.hidden.end(), 0.0); }
};

TriedEmission try_emission_of(const Scene& scene) {
    const SurfacePatches patches(scene);
    Importons importons = trace_importance(scene, {.samples = 30'000, .max_scatterings = 8, .seed = 1}, {});
    const ImportanceGuide at_d1(PhotonMap(std::move(importons.first)), 0.3f, patches, &scene, {});
    const ImportanceGuide at_d2(PhotonMap(std::move(importons.second)), 0.3f, patches, &scene, {});
    LearnedEmission learned(scene, look_for_light(scene, {.paths = 8192, .max_scatterings = 8}, {}).ends);
    EmissionTrial trial = try_emission(scene, {&at_d2, &at_d1}, {.max_scatterings = 8}, learned, 2, {});
    return {std::move(learned), std::move(trial)};
}

/// A glass ball over a floor under a dim sky, and a point of light above it, which no ray from the eye can hit.
std::unique_ptr<Scene> ball_in_the_open() {
    test::SceneMaker m;
    m.rectangle({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}, make_diffuse(Rgb(0.5)));
    m.sphere({0, 2, 0}, 1.5f, make_glass(1.5));
    m.emitter(make_constant_environment(Rgb(0.2)));
    m.emitter(make_point_emitter({3, 8, 4}, Rgb(100)));
    m.camera({0, 7, 5}, {0, 1, 0}, 50).window(48, 32);
    return m.build();
}
std::uint32_t point_of_light(const Scene& scene) { return scene.emitter(0).site() == Site::infinite ? 1 : 0; }

TEST(EmissionTrial, FindsTheCausticsThatTheEyeCannot) {
    const auto scene = ball_in_the_open();
    const TriedEmission tried = try_emission_of(*scene);
    EXPECT_GT(tried.hidden(), 0.2);
    EXPECT_GT(tried.trial.hidden[point_of_light(*scene)], 0.95 * tried.hidden());
}

TEST(EmissionTrial, KnowsThatAWindowIsWorthLearning) {
    test::SceneMaker room = test::room_with_a_window();
    room.emitter(make_constant_environment(Rgb(1.0))).camera({2.7f, 1.5f, 2.8f}, {0.8f, 0.7f, 0.4f}, 55).window(48, 32);
    const auto scene = room.build();
    const TriedEmission tried = try_emission_of(*scene);
    EXPECT_LT(tried.trial.second_moment, 0.5);
    EXPECT_LT(tried.hidden(), 0.01);
}

TEST(LearnedEmission, KeepsPathsForHiddenLight) {
    const auto scene = ball_in_the_open();
    const std::uint32_t point = point_of_light(*scene);
    TriedEmission tried = try_emission_of(*scene);
    const auto share_of_point = [&] {
        int found = 0;
        for (int i = 0; i < 20'000; ++i) {
            Rng rng(4, StreamPurpose::test, static_cast<std::uint64_t>(i));
            const auto light = tried.learned.sample(rng);
            found += light && light->x0.emitter == point ? 1 : 0;
        }
        return found / 20'000.0;
    };
    const double before = share_of_point();
    tried.learned.add_hidden(tried.trial.hidden);
    const double share = share_of_point();
    EXPECT_GT(share, 0.25);
    EXPECT_GT(share, 1.5 * before);
    // The density that is told is that of the samples: over what is drawn by power it has the same share.
    RunningStats told;
    for (int i = 0; i < 40'000; ++i) {
        Rng rng(5, StreamPurpose::test, static_cast<std::uint64_t>(i));
        const auto light = emit_light(*scene, rng);
        ASSERT_TRUE(light);
        told.add(light->x0.emitter == point ? tried.learned.density_ratio(light->x0, light->ray.w, light->ray.origin.p)
                                            : 0);
    }
    EXPECT_NEAR(told.mean(), share, 0.02 + 4 * told.standard_error());
}

} // namespace
} // namespace keyhole
