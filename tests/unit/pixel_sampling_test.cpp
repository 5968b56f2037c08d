// The loop over pixels: numbers of samples, their streams, and what an adaptive render makes of them.
#include "session/pixel_sampling.h"

#include "core/parallel.h"
#include "methods/method.h"
#include "methods/render.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace keyhole {
namespace {

Settings adaptive_settings(std::int64_t spp, std::int64_t seed = 1) {
    Settings s;
    s.spp = spp;
    s.seed = seed;
    s.adaptive = true;
    return s;
}

/// A render of a scene by samples that a test makes up.
struct MadeUp {
    explicit MadeUp(const Settings& settings, const WorkPartition& share = {})
        : s(settings), pixels(*scene, settings, share, StreamPurpose::test), film(window.width, window.height) {}

    /// Takes all rounds of samples sample(window point, random source).
    template <class Sample> void take_rounds(const Sample& sample) {
        for (std::int64_t round = 0; round < s.spp; ++round) ASSERT_TRUE(pixels.take_round(film, round, {}, sample));
    }

    const Settings s;
    const decltype(test::mirror_glass_box()) scene = test::mirror_glass_box();
    const ImageWindow& window = scene->camera().window();
    PixelSampling pixels;
    Film film;
};

PixelSample of_light(double light) {
    PixelSample s{};
    s.direct = Rgb(light, light, light);
    return s;
}

/// Of how many pixels of a quarter the halves differ in depth, which no two samples have alike: those of two samples.
double share_of_two(const Picture& picture, int right, int below) {
    const Image& noise = picture.layers.at("noise.depth");
    int two = 0;
    for (int y = 0; y < noise.height / 2; ++y)
        for (int x = 0; x < noise.width / 2; ++x)
            two += *noise.at(x + right * noise.width / 2, y + below * noise.height / 2) != 0 ? 1 : 0;
    return two / (noise.width / 2.0 * (noise.height / 2.0));
}

TEST(PixelSampling, ARoundThatIsCutShortLiesEverywhere) {
    for (const double cut : {0.25, 0.5, 1.0}) {
        MadeUp render(Settings{});
        StopToken stop;
        RunContext context;
        context.stop = &stop;
        int left = static_cast<int>(render.window.size() * (1 + cut));
        const auto sample = [&](const Vec2& /*image*/, SampleSource& source) {
            if (--left <= 0 && cut < 1) stop.request();
            PixelSample s{};
            s.depth = 1 + source.next();
            return s;
        };
        with_threads(1, [&] {
            EXPECT_TRUE(render.pixels.take_round(render.film, 0, context, sample));
            EXPECT_EQ(render.pixels.take_round(render.film, 1, context, sample), cut == 1);
        });
        const Picture picture = render.film.to_picture();
        for (const int quarter : {0, 1, 2, 3})
            EXPECT_NEAR(share_of_two(picture, quarter % 2, quarter / 2), cut, cut < 1 ? 0.1 : 0) << quarter;
    }
}

/// Half of the picture is noisy, by rare bright samples; the mean of a pixel is 1 everywhere.
PixelSample uneven(const Vec2& image, SampleSource& source, double chance) {
    if (image.x > 0.5f) return of_light(0.9 + 0.2 * source.next());
    return of_light(source.next() < chance ? 1 / chance : 0);
}

TEST(PixelSampling, PutsSamplesWhereTheNoiseIs) {
    MadeUp render(adaptive_settings(64));
    std::array<double, 2> samples{};
    double last_round = 0;
    for (std::int64_t round = 0; round < render.s.spp; ++round) {
        std::array<std::atomic<int>, 2> of_round{};
        render.pixels.take_round(render.film, round, {}, [&](const Vec2& image, SampleSource& source) {
            ++of_round[image.x > 0.5f ? 1 : 0];
            return uneven(image, source, 0.25);
        });
        for (std::size_t i = 0; i < 2; ++i) samples[i] += of_round[i];
        last_round = of_round[0] + of_round[1];
        EXPECT_DOUBLE_EQ(render.pixels.samples_per_pixel() * render.window.size(), last_round);
    }
    EXPECT_GT(samples[0], 2 * samples[1]);
    EXPECT_NEAR(last_round / render.window.size(), 1, 0.1);
    EXPECT_NEAR(render.film.samples_per_pixel(), static_cast<double>(render.s.spp), 1);
    EXPECT_EQ(render.film.empty_pixels(), 0u);
    RenderStats stats;
    render.pixels.report(stats);
    EXPECT_LT(stats.values.at("adaptive sampling, squared error over that of even samples"), 0.8);
}

TEST(PixelSampling, TakesEverySampleOnce) {
    MadeUp render(adaptive_settings(40));
    std::mutex mutex;
    std::set<std::pair<float, float>> points;
    std::size_t samples = 0;
    render.take_rounds([&](const Vec2& image, SampleSource& source) {
        const std::lock_guard lock(mutex);
        points.emplace(image.x, image.y);
        ++samples;
        return uneven(image, source, 0.25);
    });
    EXPECT_GT(static_cast<double>(points.size()), 0.999 * static_cast<double>(samples));
}

/// The mistake that the density is made to avoid: pixels that missed what is bright would get no more samples.
TEST(PixelSampling, LeavesTheMeanOfPixelsAlone) {
    RunningStats noisy, quiet;
    for (int seed = 1; seed <= 60; ++seed) {
        MadeUp render(adaptive_settings(16, seed));
        const ImageWindow& window = render.window;
        render.take_rounds([](const Vec2& image, SampleSource& source) { return uneven(image, source, 0.1); });
        for (int y = 0; y < window.height; ++y)
            for (int x = 0; x < window.width; ++x) {
                if (std::abs(x - window.width / 2) < 2) continue;
                const auto p =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(window.width) + static_cast<std::size_t>(x);
                (x > window.width / 2 ? quiet : noisy).add(render.film.mean_luminance(p));
            }
    }
    EXPECT_NEAR(noisy.mean(), 1, 4 * noisy.standard_error());
    EXPECT_NEAR(quiet.mean(), 1, 4 * quiet.standard_error());
    EXPECT_LT(noisy.standard_error(), 0.005);
}

TEST(PixelSampling, KnowsTheMeanOfThePicture) {
    MadeUp render(adaptive_settings(64));
    // Where samples are many there is twice the light: their plain mean would be too bright.
    render.take_rounds([](const Vec2& image, SampleSource& source) {
        PixelSample sample = uneven(image, source, 0.25);
        if (image.x <= 0.5f) sample.direct *= 2;
        return sample;
    });
    const RunningStats& luminances = render.pixels.luminances();
    EXPECT_NEAR(luminances.mean(), 1.5, 4 * luminances.standard_error());
    EXPECT_LT(luminances.standard_error(), 0.02);
}

TEST(PixelSampling, IsEvenWhereTheRenderHasOtherParts) {
    const auto is_even = [](const Settings& settings, const WorkPartition& share) {
        MadeUp render(settings, share);
        for (std::int64_t round = 0; round < settings.spp; ++round) {
            render.pixels.take_round(render.film, round, {}, [](const Vec2& image, SampleSource& source) {
                return uneven(image, source, 0.25);
            });
            if (render.pixels.samples_per_pixel() != 1) return false;
        }
        return true;
    };
    EXPECT_FALSE(is_even(adaptive_settings(32), {}));
    WorkPartition later, first, kept;
    later.first_pass = 1;
    first.end_pass = 1;
    kept.save = [](const Picture&) {};
    for (const WorkPartition& share : {later, first, kept}) EXPECT_TRUE(is_even(adaptive_settings(32), share));
    Settings s = adaptive_settings(32);
    s.adaptive = false;
    EXPECT_TRUE(is_even(s, {}));
    s = adaptive_settings(32);
    s.passes = 2;
    EXPECT_TRUE(is_even(s, {}));
    EXPECT_TRUE(is_even(adaptive_settings(15), {})); // too few for a pilot
}

/// Renders of a method with many samples, even and adaptive, have the same light in each layer.
class AdaptiveSampling : public testing::TestWithParam<const char*> {};

TEST_P(AdaptiveSampling, LeavesEachLayerAlone) {
    const auto scene = test::mirror_glass_box();
    Settings s = adaptive_settings(24);
    s.method = &method_named(GetParam());
    s.light_paths = 10'000;
    s.mutations = 40'000;
    s.brightness_samples = s.importons = 10'000;
    s.chains = 100;
    s.cache_rays = 100;
    std::map<std::string, std::array<RunningStats, 2>> means;
    for (s.seed = 1; s.seed <= 5; ++s.seed)
        for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
            s.adaptive = k == 1;
            const Picture picture = render(*scene, s, {}).picture;
            for (const char* name : {"direct", "indirect", "caustic", "albedo", "depth"}) {
                const auto layer = picture.layers.find(name);
                if (layer == picture.layers.end()) continue;
                double sum = 0;
                for (const float v : layer->second.data) sum += static_cast<double>(v);
                means[name][k].add(sum / static_cast<double>(layer->second.data.size()));
            }
        }
    for (const auto& [name, of] : means) {
        const double error = std::hypot(of[0].standard_error(), of[1].standard_error());
        EXPECT_NEAR(of[0].mean(), of[1].mean(), 4 * error + 1e-6) << name;
        EXPECT_LT(error, 0.3 * of[0].mean() + 1e-6) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, AdaptiveSampling, testing::Values("path", "bdpt", "ipm", "mlt"),
                         [](const auto& info) { return std::string(info.param); });

} // namespace
} // namespace keyhole
