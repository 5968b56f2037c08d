// A sample of each emitter at what is seen first: the same light as by one that is chosen, and where it pays.
#include "core/shared_work.h"
#include "core/statistics.h"
#include "methods/learned_direct_light_scope.h"
#include "methods/method.h"
#include "methods/pixel_sink.h"
#include "sampling/guidance/learned/look_for_direct_light.h"
#include "scene/bsdfs/diffuse.h"
#include "scene/emitters/emitters.h"
#include "support/chance.h"
#include "support/test_scenes.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace keyhole {
namespace {

constexpr int kAcross = 4, kDown = 3;

/// Luminance of blocks of the picture, by paths.
std::vector<RunningStats> blocks(Scene& scene, bool each, int samples, std::uint64_t stream) {
    scene.set_takes_each_emitter(each);
    std::vector<RunningStats> result(kAcross * kDown);
    const ImageWindow& window = scene.camera().window();
    for (int i = 0; i < samples; ++i) {
        Rng rng(stream, StreamPurpose::test, static_cast<std::uint64_t>(i));
        const double x = rng.next(), y = rng.next();
        PixelSink sink{};
        trace_path(scene,
                   window.to_window({static_cast<float>(x * window.width), static_cast<float>(y * window.height)}), 6,
                   rng, sink);
        const auto block =
            static_cast<std::size_t>(static_cast<int>(y * kDown) * kAcross + static_cast<int>(x * kAcross));
        result[block].add(luminance(sink.pixel.direct + sink.pixel.indirect + sink.pixel.caustic));
    }
    scene.set_takes_each_emitter(false);
    return result;
}

/// Largest difference of a block [standard errors].
double worst(const std::vector<RunningStats>& a, const std::vector<RunningStats>& b, double planted = 1) {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        most = std::max(most, std::abs(planted * a[i].mean() - b[i].mean()) /
                                  std::hypot(a[i].standard_error(), b[i].standard_error()));
    return most;
}

/// Rough metal that reflects two lamps, one of them turned away from most of what is seen, and a small sun.
std::unique_ptr<Scene> lamps_over_metal() {
    const MaterialPtr white = make_diffuse(Rgb(0.5));
    const auto value = [](double x) { return constant_texture(x); };
    test::SceneMaker m;
    return m
        .rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0},
                   make_conductor(constant_texture(Rgb(0.8)), value(0.15), value(0.15)))
        .rectangle({-2, 0, -2}, {4, 0, 0}, {0, 2, 0}, white)
        .rectangle({-0.5f, 1.5f, -0.5f}, {1, 0, 0}, {0, 0, 1}, white, Rgb(3.0))
        .rectangle({1.2f, 0.5f, -1.9f}, {0, 0.8f, 0}, {0.6f, 0, 0}, white, Rgb(6.0))
        .emitter(make_distant_emitter(Vec3(0.3f, -1, -0.4f).normalized(), Rgb(0.8)))
        .camera({0, 1.2f, 3}, {0, 0, 1}, 70)
        .window(32, 24)
        .build();
}

std::unique_ptr<Scene> room_with_sky_and_sun() {
    auto m = test::room_with_a_window();
    m.camera({1.5f, 1.3f, 2.9f}, {1.5f, 1.0f, 0}, 80).window(32, 24);
    m.emitter(make_constant_environment(Rgb(1, 2, 3)));
    m.emitter(make_distant_emitter(Vec3(0.2f, -0.6f, 0.7f).normalized(), Rgb(3)));
    return m.build();
}

TEST(EachEmitter, BringsTheLightOfOneThatIsChosen) {
    const auto scene = lamps_over_metal();
    const auto one = blocks(*scene, false, 480'000, 1), each = blocks(*scene, true, 480'000, 2);
    EXPECT_LT(worst(one, each), test::most_errors(kAcross * kDown));
    EXPECT_GT(worst(one, each, 1.05), test::most_errors(kAcross * kDown)) << "a twentieth has to show";
}

/// A sun that no ray sees: the lamp, which has all of the light, is chosen once in a hundred times and more.
std::unique_ptr<Scene> lamp_beside_a_hidden_sun() {
    test::SceneMaker m;
    return m.room({-1, 0, -1}, {1, 2, 3}, make_diffuse(Rgb(0.6)))
        .rectangle({-0.3f, 1.99f, 0}, {0.6f, 0, 0}, {0, 0, 0.6f}, make_black(), Rgb(3.0))
        .emitter(make_distant_emitter({0, -1, 0}, Rgb(30.0)))
        .camera({0, 1, 2.9f}, {0, 0.6f, 0}, 60)
        .window(32, 24)
        .build();
}

TEST(EachEmitter, BringsItWhereItWouldHardlyBeChosen) {
    const auto scene = lamp_beside_a_hidden_sun();
    const auto one = blocks(*scene, false, 300'000, 6), each = blocks(*scene, true, 300'000, 7);
    EXPECT_LT(worst(one, each), test::most_errors(kAcross * kDown));
    EXPECT_GT(worst(one, each, 1.3), test::most_errors(kAcross * kDown)) << "three tenths have to show";
}

TEST(EachEmitter, BringsItWhereDirectLightWasLearned) {
    const auto scene = room_with_sky_and_sun();
    scene->set_direct_light(learn_direct_light(*scene, {.paths = 16'384}, {}));
    ASSERT_NE(scene->direct_light(), nullptr);
    const auto one = blocks(*scene, false, 300'000, 3), each = blocks(*scene, true, 300'000, 4);
    EXPECT_LT(worst(one, each), test::most_errors(kAcross * kDown));
    EXPECT_GT(worst(one, each, 1.1), test::most_errors(kAcross * kDown)) << "a tenth has to show";
}

/// Points of a given emitter have the density that is told: their reciprocals add up to what they are spread over.
TEST(EachEmitter, IsDrawnWithTheDensityOfWhatWasLearned) {
    const auto scene = room_with_sky_and_sun();
    const auto learned = learn_direct_light(*scene, {.paths = 16'384}, {});
    ASSERT_TRUE(learned);
    SurfacePoint at;
    at.p = {1.5f, 0, 1.5f};
    at.ng = at.ns = {0, 1, 0};
    Rng rng(5, StreamPurpose::test, 0);
    std::map<std::uint32_t, double> chosen;
    constexpr int kSamples = 100'000;
    for (int i = 0; i < kSamples; ++i) chosen[learned->sample(at, rng).point.emitter] += 1.0 / kSamples;
    for (std::uint32_t e = 0; e < 2; ++e) {
        const double p = learned->probability(at, e);
        EXPECT_NEAR(chosen[e], p, 5 * std::sqrt(p * (1 - p) / kSamples));
        RunningStats spread;
        for (int i = 0; i < kSamples; ++i) {
            const double u = rng.next();
            const EmitterPoint x0 = learned->sample_of(at, e, u, rng);
            ASSERT_EQ(x0.point.emitter, e);
            ASSERT_NEAR(x0.pdf, learned->pdf(at, x0.point), 1e-9 * x0.pdf);
            spread.add(p / x0.pdf);
        }
        const double expected = scene->emitter(e).is_delta() ? 1 : 4 * kPi;
        EXPECT_NEAR(spread.mean(), expected, 5 * spread.standard_error() + 1e-6);
    }
}

TEST(EachEmitter, PaysWhereTheChoiceIsTheNoise) {
    Settings s;
    s.method = &methods::path;
    s.spp = 256;
    const auto lamps = [](const MaterialPtr& floor) {
        test::SceneMaker m;
        return m.rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, floor)
            .rectangle({-0.5f, 2.5f, -0.5f}, {1, 0, 0}, {0, 0, 1}, make_black(), Rgb(3.0))
            .emitter(make_distant_emitter({0, -1, 0}, Rgb(1.0)))
            .camera({0, 2, 3}, {0, 0, 0}, 40)
            .window(64, 48)
            .build();
    };
    const auto open = lamps(make_diffuse(Rgb(0.5)));
    EXPECT_TRUE(each_emitter_pays(*open, s, {}));
    EXPECT_FALSE(open->takes_each_emitter()) << "that is the caller's to decide";
    s.spp = 1;
    EXPECT_FALSE(each_emitter_pays(*open, s, {})) << "no time for a trial";
    s.spp = 256;
    EXPECT_FALSE(each_emitter_pays(*test::diffuse_box(), s, {})) << "one lamp";
    EXPECT_FALSE(each_emitter_pays(*lamps(make_black()), s, {})) << "nothing is seen";
}

TEST(EachEmitter, TrialLeavesTheSceneAsItWasWhereItIsStopped) {
    const auto scene = lamps_over_metal();
    scene->set_takes_each_emitter(true);
    Settings s;
    s.spp = 1024;
    StopToken stop;
    stop.request();
    RunContext context;
    context.stop = &stop;
    EXPECT_THROW(each_emitter_pays(*scene, s, context), Interrupted);
    EXPECT_TRUE(scene->takes_each_emitter());
}

} // namespace
} // namespace keyhole
