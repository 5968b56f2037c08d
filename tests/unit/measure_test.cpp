// The path tracer carries throughputs along; measure() takes a finished path apart. They must tell the same story.
#include "sampling/paths/path_tracer.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

/// Compares each contribution of the tracer with contribution over density of the measured path.
struct RatioCheck {
    const Scene& scene;
    Vec2 image;
    int checked = 0, with_glass = 0, wrong = 0;

    bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }

    void contribution(const EyeWalk& walk, const Vertex& x0, const Rgb& value, LightClass /*light*/) {
        if (walk.size() > 5) return; // no roulette before
        const Path path = complete_path(scene, walk, x0, image);
        double eye = 1; // density of all vertices but x0 when traced from the eye
        for (std::size_t i = 1; i < path.x.size(); ++i) eye *= path.x[i].pdf_from_eye;
        const double by_hit = path.x[0].pdf_from_eye, by_light = path.x[0].pdf_from_light;
        const bool connectable = path.x.size() > 2 && !path.x[1].specular();
        const double by_both = !connectable || by_hit == 0 ? 0 : (by_hit * by_hit + by_light * by_light);
        // The two techniques' estimates with their power-heuristic weights.
        const double hit = connectable ? (by_hit > 0 ? by_hit / by_both : 0) : 1 / by_hit;
        const double light = connectable ? (by_both > 0 ? by_light / by_both : 1 / by_light) : 0;
        const double f = luminance(path.contribution) / eye, y = luminance(value);
        const double error = std::min(std::abs(f * hit - y), std::abs(f * light - y)) / y;
        wrong += error > 0.02 ? 1 : 0; // positions and directions are floats
        ++checked;
        for (const Vertex& v : path.x) with_glass += v.event == Event::transmit ? 1 : 0;
    }
};

/// `most_wrong`: a ray that meets a medium in an edge may be told inside by one of its ends and outside by the other.
void expect_agreement(const Scene& scene, bool glass, int most_wrong = 0) {
    RatioCheck check{scene, {}};
    Rng rng(7, StreamPurpose::test, 0);
    for (int i = 0; i < 20000; ++i) {
        check.image = Vec2(static_cast<float>(rng.next()), static_cast<float>(rng.next()));
        trace_path(scene, check.image, 12, rng, check);
    }
    EXPECT_GT(check.checked, 10000);
    EXPECT_EQ(check.with_glass > 500, glass);
    EXPECT_LE(check.wrong, most_wrong);
}

TEST(Measure_AgreesWithPathTracer, DiffuseBox) { expect_agreement(*test::diffuse_box(), false); }
TEST(Measure_AgreesWithPathTracer, MirrorAndGlass) { expect_agreement(*test::mirror_glass_box(), true); }
TEST(Measure_AgreesWithPathTracer, ThinLens) { expect_agreement(*test::mirror_glass_box(0.1f), true); }
TEST(Measure_AgreesWithPathTracer, PointLight) { expect_agreement(*test::point_light_box(), false); }
TEST(Measure_AgreesWithPathTracer, Haze) { expect_agreement(*test::hazy_box(), true, 2); }
TEST(Measure_AgreesWithPathTracer, Sky) { expect_agreement(*test::sky_box(), true); }
TEST(Measure_AgreesWithPathTracer, DistantLight) { expect_agreement(*test::distant_light_scene(), true); }
TEST(Measure_AgreesWithPathTracer, Spot) { expect_agreement(*test::spot_scene(), false); }

} // namespace
} // namespace keyhole
