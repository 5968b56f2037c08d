// Independent paths along user paths: they change what is found often, and nothing of what is found on average.
#include "core/parallel.h"
#include "core/statistics.h"
#include "sampling/brightness.h"
#include "sampling/guidance/guided_light.h"
#include "support/chance.h"
#include "support/test_scenes.h"
#include "support/user_paths.h"

#include <gtest/gtest.h>

#include <array>

namespace keyhole {
namespace {

class AlongUserPaths : public testing::TestWithParam<std::size_t> {
  protected:
    std::unique_ptr<Scene> scene = test::guided_scenes()[GetParam()].make();
    UserPaths paths = bind_user_paths(*scene, test::guided_scenes()[GetParam()].paths(*scene));
};

constexpr int kDepth = 8;
constexpr std::size_t kParts = 16; // of the scene, along its diagonal; twice: before and after a specular vertex

/// Power that arrives in parts of the scene.
struct Arrivals {
    const Scene& scene;
    std::array<double, 2 * kParts> power{};

    bool arrival(const Vertex& v, const Vec3&, const Rgb& carried, const LightPast& past) {
        const Vec3 size = scene.upper() - scene.lower(), p = v.point.p - scene.lower();
        const double along = (p.x / size.x + p.y / size.y + p.z / size.z) / 3;
        const auto part = std::min(kParts - 1, static_cast<std::size_t>(along * kParts));
        power[part + (past.specular ? kParts : 0)] += luminance(carried);
        return past.scatterings + 1 < kDepth;
    }
};

using PowerByPart = std::array<RunningStats, 2 * kParts>;

PowerByPart trace(const Scene& scene, std::int64_t count, std::uint64_t seed, auto&& trace_one) {
    PowerByPart all;
    for (std::int64_t i = 0; i < count; ++i) {
        Rng rng(seed, StreamPurpose::test, static_cast<std::uint64_t>(i));
        Arrivals sink{scene};
        trace_one(rng, sink);
        for (std::size_t k = 0; k < all.size(); ++k) all[k].add(sink.power[k]);
    }
    return all;
}

void expect_same_power(const PowerByPart& free, const PowerByPart& guided) {
    int told = 0;
    for (std::size_t k = 0; k < free.size(); ++k) {
        if (!(free[k].mean() > 20 * free[k].standard_error())) continue; // too little light to say
        EXPECT_TRUE(test::same_mean(free[k], guided[k], 2 * kParts))
            << "part " << k << ", ratio " << guided[k].mean() / free[k].mean();
        ++told;
    }
    EXPECT_GE(told, 8);
}

PowerByPart trace_free(const Scene& scene) {
    return trace(scene, 400'000, 1, [&](Rng& rng, Arrivals& sink) { trace_light_path(scene, kDepth, rng, sink); });
}

TEST_P(AlongUserPaths, LightArrivesWithThePowerThatItHasWithoutThem) {
    const LightGuides guides(*scene, paths);
    expect_same_power(trace_free(*scene), trace(*scene, 400'000, 2, [&](Rng& rng, Arrivals& sink) {
                          trace_guided_light_path(*scene, {&guides}, kDepth, rng, sink);
                      }));
}

/// User paths beside emission that was learned, through a slit.
TEST(AlongUserPathsAndLearned, LightArrivesWithThePowerThatItHas) {
    const auto scene = test::two_rooms(1);
    const UserPaths paths = bind_user_paths(*scene, test::two_rooms_paths(*scene, 1));
    const LightGuides guides(*scene, paths);
    const LearnedEmission learned(*scene, look_for_light(*scene, {.paths = 8192, .max_scatterings = kDepth}, {}).ends);
    const PowerByPart free = trace_free(*scene);
    const auto with = [&](const LightPathSampling& sampling) {
        return trace(*scene, 200'000, 2,
                     [&](Rng& rng, Arrivals& sink) { trace_guided_light_path(*scene, sampling, kDepth, rng, sink); });
    };
    const PowerByPart led = with({&guides}), both = with({&guides, &learned});
    expect_same_power(free, both);
    // And it is another sampler than the one that has learned nothing.
    EXPECT_NE(led[0].variance(), both[0].variance());
}

TEST_P(AlongUserPaths, StageOneFindsTheSameBrightness) {
    const GuidedPaths guides(*scene, paths, PathSet::stored, kDepth);
    StageOneSettings settings{.max_scatterings = kDepth, .samples = 150'000, .seed = 3};
    const StageOne without = run_stage_one(*scene, settings, {});
    settings.seed = 4;
    settings.guides = &guides;
    const StageOne with = run_stage_one(*scene, settings, {});
    EXPECT_TRUE(test::same_mean(with.brightness, without.brightness, 2))
        << with.brightness.mean() / without.brightness.mean();
    if (without.caustic.mean() > 20 * without.caustic.standard_error()) {
        EXPECT_TRUE(test::same_mean(with.caustic, without.caustic, 2)) << with.caustic.mean() / without.caustic.mean();
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, AlongUserPaths, testing::Range<std::size_t>(0, test::guided_scenes().size()),
                         [](const auto& info) { return test::guided_scenes()[info.param].name; });

// The longest paths that are looked for count as well.
TEST(ShortPaths, HaveTheBrightnessThatTheyHaveWithoutUserPaths) {
    const auto scene = test::diffuse_box();
    const UserPaths paths =
        bind_user_paths(*scene, {{test::user_path("to the floor", {{0, 1.95f, 0}, {0.2f, 0, 0.4f}}, 0.9)}});
    for (const int depth : {3, 4}) {
        const GuidedPaths guides(*scene, paths, PathSet::stored, depth);
        StageOneSettings settings{.max_scatterings = depth, .samples = 100'000, .seed = 3};
        const StageOne without = run_stage_one(*scene, settings, {});
        settings.seed = 4;
        settings.guides = &guides;
        const StageOne with = run_stage_one(*scene, settings, {});
        EXPECT_TRUE(test::same_mean(with.brightness, without.brightness, 2))
            << "depth " << depth << ": " << with.brightness.mean() / without.brightness.mean();
    }
}

/// Through a slit of 3 cm in a wall of 10, by which a free path goes once in some hundred times.
TEST(ThroughASlit, UserPathsFindLightThatIsHardToFind) {
    constexpr float kSlit = 0.03f;
    const auto scene = test::two_rooms(kSlit);
    const UserPaths paths = test::bounces_through(*scene, kSlit, kDepth - 1);
    const GuidedPaths guides(*scene, paths, PathSet::stored, kDepth);
    StageOneSettings settings{.max_scatterings = kDepth, .samples = 100'000, .seed = 3};
    const StageOne without = run_stage_one(*scene, settings, {});
    settings.guides = &guides;
    const StageOne with = run_stage_one(*scene, settings, {});
    EXPECT_LT(with.brightness.standard_error(), 0.5 * without.brightness.standard_error());
    EXPECT_TRUE(test::same_mean(with.brightness, without.brightness, 2));

    const auto beyond = [&](auto&& trace_one) {
        RunningStats power;
        for (std::uint64_t i = 0; i < 100'000; ++i) {
            Rng rng(5, StreamPurpose::test, i);
            struct {
                double power = 0;
                bool arrival(const Vertex& v, const Vec3&, const Rgb& carried, const LightPast&) {
                    if (v.point.p.z > 0) power += luminance(carried);
                    return true;
                }
            } sink;
            trace_one(rng, sink);
            power.add(sink.power);
        }
        return power;
    };
    const LightGuides light(*scene, paths);
    const RunningStats free = beyond([&](Rng& rng, auto& sink) { trace_light_path(*scene, kDepth, rng, sink); });
    const RunningStats led =
        beyond([&](Rng& rng, auto& sink) { trace_guided_light_path(*scene, {&light}, kDepth, rng, sink); });
    EXPECT_LT(led.standard_error(), 0.5 * free.standard_error());
    EXPECT_TRUE(test::same_mean(led, free, 2));
}

/// Light that creeps along the wall into the door's corners carries no more than other light.
TEST(ThroughASlit, NoPhotonIsMuchBrighterThanOthers) {
    constexpr float kSlit = 0.003f;
    const auto scene = test::two_rooms(kSlit, true);
    const UserPaths paths = test::bounces_through(*scene, kSlit, kDepth - 1);
    const LightGuides light(*scene, paths);
    struct {
        double power = 0;
        bool arrival(const Vertex& v, const Vec3&, const Rgb& carried, const LightPast& past) {
            const bool beyond = v.point.p.z > -0.06f;
            if (beyond && past.scatterings > 0) power = luminance(carried); // straight from the lamp no user path leads
            return !beyond;
        }
    } sink;
    double sum = 0, squares = 0;
    for (std::uint64_t i = 0; i < 400'000; ++i) {
        Rng rng(7, StreamPurpose::test, i);
        sink.power = 0;
        trace_guided_light_path(*scene, {&light}, kDepth, rng, sink);
        sum += sink.power;
        squares += sink.power * sink.power;
    }
    EXPECT_GT(sum * sum / squares, 80'000); // photons of equal power that would be as good a sample
}

} // namespace
} // namespace keyhole
