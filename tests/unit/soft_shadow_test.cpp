// Direct light at one point by several samples of emitters: the right mean, less noise than by as many independent
// ones.
#include "core/statistics.h"
#include "gather/direct_light.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace keyhole {
namespace {

constexpr double kAlbedo = 0.5, kRadiance = 5;

/// A floor under a square lamp of 1 m, 2 m above it; of which a shelf may hide one half.
class UnderALamp {
  public:
    explicit UnderALamp(bool shelf) {
        const auto gray = make_diffuse(Rgb(kAlbedo)), black = make_diffuse(Rgb(0.0));
        test::SceneMaker m;
        m.rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, gray)
            .rectangle({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}, black, Rgb(kRadiance))
            .camera({0, 0.5f, 4}, {0, 0, 0}, 60)
            .window(8, 8);
        if (shelf) m.rectangle({0, 1, -3}, {3, 0, 0}, {0, 0, 6}, black);
        scene_ = m.build();
        SurfacePoint above;
        above.site = Site::point;
        above.p = {0, 0.5f, 0};
        const auto floor = scene_->trace(above, Vec3(0, -1, 0));
        if (!floor) throw std::logic_error("the floor is not where it should be");
        floor_ = make_vertex(*floor);
    }

    /// Of next_event() or direct_light(), by so many samples of emitters.
    template <class Estimate> RunningStats estimates(const Estimate& estimate, int samples) const {
        RunningStats stats;
        for (std::uint64_t i = 0; i < 20'000; ++i) {
            Rng rng(1, StreamPurpose::test, i);
            stats.add(estimate(*scene_, floor_, Vec3(0, 1, 0), {samples}, rng).x);
        }
        return stats;
    }

  private:
    std::unique_ptr<Scene> scene_;
    Vertex floor_;
};

TEST(SoftShadow, HasTheSameMeanHoweverManySamples) {
    const UnderALamp scene(true);
    const RunningStats one = scene.estimates(next_event, 1), four = scene.estimates(next_event, 4);
    EXPECT_GT(one.mean(), 0.01);
    EXPECT_TRUE(test::same_mean(one, four));
}

TEST(SoftShadow, IsSmootherThanByIndependentSamples) {
    const UnderALamp scene(true);
    EXPECT_LT(scene.estimates(next_event, 4).variance(), 0.6 * scene.estimates(next_event, 1).variance() / 4);
}

TEST(DirectLight, OfBothTechniquesIsThatOfTheClosedForm) {
    // Of the light that leaves a point of the floor evenly, what meets a quarter of the lamp, corner above the point.
    const double a = 0.5 / 2, root = std::sqrt(1 + a * a);
    const double quarter = 2 * (a / root * std::atan(a / root)) / (2 * kPi);
    const double expected = kAlbedo * kRadiance * 4 * quarter;
    const UnderALamp open(false), shelf(true);
    for (const int samples : {1, 4}) {
        const RunningStats all = open.estimates(direct_light, samples), half = shelf.estimates(direct_light, samples);
        EXPECT_TRUE(test::has_mean(all, expected, 4));
        EXPECT_LT(all.standard_error(), 0.01 * expected) << "too noisy to mean anything";
        EXPECT_TRUE(test::has_mean(half, expected / 2, 4));
    }
}

} // namespace
} // namespace keyhole
