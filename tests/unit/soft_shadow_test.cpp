// Several samples of emitters at one point: the same mean, less noise than as many independent ones.
#include "core/statistics.h"
#include "gather/direct_light.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// A floor under a lamp, half of which a shelf hides.
class SoftShadow : public testing::Test {
  protected:
    SoftShadow() {
        const auto gray = make_diffuse(Rgb(0.5)), black = make_diffuse(Rgb(0.0));
        test::SceneMaker m;
        m.rectangle({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, gray)
            .rectangle({-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}, black, Rgb(5.0))
            .rectangle({0, 1, -3}, {3, 0, 0}, {0, 0, 6}, black)
            .camera({0, 0.5f, 4}, {0, 0, 0}, 60)
            .window(8, 8);
        scene_ = m.build();
        SurfacePoint above;
        above.site = Site::point;
        above.p = {0.02f, 0.5f, 0.03f};
        const auto floor = scene_->trace(above, Vec3(0, -1, 0));
        if (!floor) throw std::logic_error("the floor is not where it should be");
        floor_ = make_vertex(*floor);
    }

    RunningStats estimates(int samples) const {
        RunningStats stats;
        for (std::uint64_t i = 0; i < 20'000; ++i) {
            Rng rng(1, StreamPurpose::test, i);
            stats.add(next_event(*scene_, floor_, Vec3(0, 1, 0), samples, rng).x);
        }
        return stats;
    }

    std::unique_ptr<Scene> scene_;
    Vertex floor_;
};

TEST_F(SoftShadow, HasTheSameMeanHoweverManySamples) {
    const RunningStats one = estimates(1), four = estimates(4);
    EXPECT_GT(one.mean(), 0.01);
    EXPECT_LT(std::abs(one.mean() - four.mean()), 4 * std::hypot(one.standard_error(), four.standard_error()));
}

TEST_F(SoftShadow, IsSmootherThanByIndependentSamples) {
    EXPECT_LT(estimates(4).variance(), 0.6 * estimates(1).variance() / 4);
}

} // namespace
} // namespace keyhole
