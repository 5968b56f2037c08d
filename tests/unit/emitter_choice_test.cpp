// The light tree's choice: probabilities that add up, are those of the samples, and follow the effect.
#include "scene/emitters/emitters.h"
#include "scene/light_tree.h"
#include "support/chi_squared.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

std::unique_ptr<Scene> many_lights() {
    test::SceneMaker m;
    Rng rng(3, StreamPurpose::test, 0);
    const auto number = [&](double low, double high) { return static_cast<float>(low + (high - low) * rng.next()); };
    m.rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, make_diffuse(Rgb(0.5)));
    for (int i = 0; i < 12; ++i) {
        const Vec3 p(number(-5, 5), number(0.5, 3), number(-5, 5));
        if (i % 3 == 0) m.emitter(make_point_emitter(p, Rgb(number(0.1, 5))));
        if (i % 3 == 1)
            m.rectangle(p, {number(0.1, 1), 0, 0}, {0, number(-1, 1), 0.5f}, make_diffuse(Rgb(0.0)), Rgb(number(1, 9)),
                        i % 2 == 0);
        if (i % 3 == 2)
            m.emitter(make_spot_emitter({.position = p, .axis = {0, -1, 0}, .intensity = Rgb(number(1, 9))}));
    }
    m.emitter(make_distant_emitter({0, -1, 0}, Rgb(0.2))).emitter(make_constant_environment(Rgb(0.02)));
    return m.build();
}

SurfacePoint floor_point(float x, float z) {
    SurfacePoint s;
    s.p = Vec3(x, 0, z);
    s.ng = s.ns = Vec3(0, 1, 0);
    return s;
}

TEST(LightTree_Probabilities, AreThoseOfTheSamples) {
    const auto scene = many_lights();
    const LightTree& tree = scene->light_tree();
    Rng rng(4, StreamPurpose::test, 0);
    for (int k = 0; k < 5; ++k) {
        const SurfacePoint point =
            floor_point(static_cast<float>(10 * rng.next() - 5), static_cast<float>(10 * rng.next() - 5));
        constexpr int n = 40'000;
        test::Histogram h;
        double sum = 0;
        for (std::uint32_t i = 0; i < scene->emitters().size(); ++i) {
            const double p = tree.probability(point, i);
            EXPECT_GE(p, 0.1 * scene->emitter_distribution().probability(i)) << "a floor for each";
            sum += p;
            h.expected.push_back(n * p);
        }
        EXPECT_NEAR(sum, 1, 1e-9);
        h.observed.assign(h.expected.size(), 0);
        for (int i = 0; i < n; ++i) {
            const LightTree::Choice c = tree.sample(point, rng.next());
            h.observed[c.emitter] += 1;
            ASSERT_EQ(c.probability, tree.probability(point, c.emitter));
        }
        EXPECT_GT(h.p_value(), test::sidak_threshold(5));
    }
}

TEST(LightTree_Choice, FollowsTheEffectNotThePower) {
    test::SceneMaker m;
    m.rectangle({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}, make_diffuse(Rgb(0.5)));
    for (int i = 0; i < 10; ++i)
        m.emitter(make_point_emitter({-45.0f + 10.0f * static_cast<float>(i), 1, 0}, Rgb(1.0)));
    const auto scene = m.build();
    EXPECT_GT(scene->light_tree().probability(floor_point(5.1f, 0), 5), 0.6) << "by power it is 0.1";
    EXPECT_LT(scene->light_tree().probability(floor_point(5.1f, 0), 9), 0.05);
}

TEST(LightTree_Choice, IsThatByPowerWithAFloorForFewEmitters) {
    test::SceneMaker m;
    m.rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, make_diffuse(Rgb(0.5)));
    m.emitter(make_point_emitter({0, 1, 0}, Rgb(1.0))).emitter(make_point_emitter({4, 1, 0}, Rgb(3.0)));
    const auto scene = m.build();
    // A tenth of the power is spread evenly, so that the strong one does not starve the weak one.
    EXPECT_NEAR(scene->light_tree().probability(floor_point(0, 0), 0), (1 + 0.2) / (4 + 0.4), 1e-6);
}

// Rounding makes the angle between two lamps that look the same way a little more than nothing.
TEST(LightTree_Choice, KnowsWhichLampsFaceAway) {
    for (const float tilt : {0.0f, 0.1f, 0.2f, 0.7f, 0.8f}) {
        test::SceneMaker m;
        m.rectangle({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}, make_diffuse(Rgb(0.5)));
        const Vec3 u(0.2f * std::cos(tilt), 0.2f * std::sin(tilt), 0), v(0, 0, 0.2f);
        for (int i = 0; i < 16; ++i) {
            const Vec3 corner(static_cast<float>(i % 8) - 4, i < 8 ? 2.0f : 2.5f, 0);
            m.rectangle(corner, i < 8 ? u : v, i < 8 ? v : u, make_diffuse(Rgb(0.0)), Rgb(1.0));
        }
        const auto scene = m.build();
        double facing = 0, away = 0;
        for (std::uint32_t i = 0; i < 16; ++i)
            (i < 8 ? facing : away) += scene->light_tree().probability(floor_point(0.3f, 0.2f), i);
        EXPECT_LT(std::min(facing, away), 0.2) << tilt;
    }
}

} // namespace
} // namespace keyhole
