// Gather rays of glossy parts, however many there are: what they meet of emitters is a share of direct light.
#include "gather/direct_light.h"
#include "gather/fill_cache.h"
#include "gather/final_gather.h"
#include "sampling/paths/path_tracer.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

/// A glossy floor that reflects a lamp which is as large: rays of the BSDF find most of what is seen of it.
std::unique_ptr<Scene> floor_under_a_wide_lamp() {
    const auto value = [](double x) { return constant_texture(x); };
    const auto gloss = make_coated_diffuse(constant_texture(Rgb(0.2)), value(0.15), value(0.15), 1.8, value(0));
    test::SceneMaker m;
    m.rectangle({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, gloss)
        .rectangle({-2, 1, -2}, {4, 0, 0}, {0, 0, 4}, make_diffuse(Rgb(0.0)), Rgb(5.0))
        .camera({0, 0.6f, 1.5f}, {0, 0, 0}, 40)
        .window(16, 16);
    return m.build();
}

/// Sums what paths of one scattering bring.
struct OneScattering {
    double sum = 0;
    static bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }
    void contribution(const EyeWalk& /*walk*/, const Vertex& /*x0*/, const Rgb& value, LightClass /*light*/) {
        sum += luminance(value);
    }
};

TEST(GlossyGather, FindsAllDirectLightByAnyNumberOfRays) {
    const auto scene = floor_under_a_wide_lamp();
    const GatherRays rays(*scene, {}, {.max_radius = 0.1f, .caustic_radius = 0.1f}, 24);
    const IrradianceCache cache = fill_cache(rays, {}, {}, {});
    const auto mean = [](const auto& of_sample, std::uint64_t stream) {
        RunningStats stats;
        for (std::uint64_t i = 0; i < 100'000; ++i) {
            Rng rng(stream, StreamPurpose::test, i);
            const double x = rng.next(), y = rng.next();
            stats.add(of_sample(Vec2(static_cast<float>(x), static_cast<float>(y)), rng));
        }
        return stats;
    };
    const RunningStats expected = mean(
        [&](const Vec2& at, Rng& rng) {
            OneScattering sink;
            trace_path(*scene, at, 1, rng, sink);
            return sink.sum;
        },
        1);
    EXPECT_LT(expected.standard_error(), 0.01 * expected.mean());
    std::uint64_t stream = 2;
    for (const double number : {0.4, 1.0, 2.5, 8.0}) {
        const FinalGather gather(rays, &cache, nullptr, {.light = 1, .rays = number});
        const RunningStats direct =
            mean([&](const Vec2& at, Rng& rng) { return luminance(gather.sample(at, rng).direct); }, stream++);
        EXPECT_TRUE(test::same_mean(direct, expected, 4)) << number << " rays";
        EXPECT_LT(gather.starving(), 0.01) << "the cache serves";
    }
}

} // namespace
} // namespace keyhole
