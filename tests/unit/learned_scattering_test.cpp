// Light paths that go on to where they are wanted: densities that are those of the samples, power that arrives in full,
// and far more of the paths where they count.
#include "core/statistics.h"
#include "sampling/guidance/learned/learned_emission.h"
#include "sampling/guidance/learned/learned_scattering.h"
#include "sampling/paths/light_tracer.h"
#include "sampling/paths/measure.h"
#include "scene/emitters/emitters.h"
#include "scene/texture.h"
#include "support/chance.h"
#include "support/test_scenes.h"
#include "support/window_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace keyhole {
namespace {

constexpr int kDepth = 5;

/// A room whose window looks over a yard: most of its light has been scattered by the yard, little of what that
/// scatters comes in. The curtain before it lets light through.
std::unique_ptr<Scene> room_over_a_yard() {
    auto m = test::room_with_a_window();
    m.rectangle({-10, -2, -20}, {0, 0, 19.9f}, {20, 0, 0}, make_diffuse(Rgb(0.6)));
    m.rectangle({1.4f, 0.9f, 0.1f}, {0.5f, 0, 0}, {0, 1, 0},
                make_diffuse_transmission(constant_texture(Rgb(0.4)), constant_texture(Rgb(0.4))));
    m.emitter(make_constant_environment(Rgb(1, 2, 3)));
    m.camera({1.5f, 1.3f, 2.9f}, {1.5f, 1.2f, 0}, 60).window(32, 24);
    return m.build();
}

/// Power that arrives at walls of the room [W], and how many paths bring any.
struct Arrivals {
    std::array<RunningStats, 4> walls; // floor, ceiling, back, left
    int paths = 0;
};

template <class Scattering>
Arrivals trace(const Scene& scene, const LearnedEmission& emission, const Scattering& scattering, int paths,
               std::uint64_t stream) {
    struct Sink {
        std::array<double, 4> walls{};
        bool arrival(const Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast& past) {
            // What came straight from the sky was scattered nowhere.
            if (past.scatterings == 0) return true;
            const Vec3& p = v.point.p;
            const double y = luminance(power);
            if (std::abs(p.y) < 1e-3f && to_light.y > 0 && p.z > 0) walls[0] += y;
            if (p.y > 2.499f && to_light.y < 0) walls[1] += y;
            if (p.z > 2.999f && to_light.z < 0) walls[2] += y;
            if (p.x < 1e-3f && p.x > -1e-3f && to_light.x > 0) walls[3] += y;
            return true;
        }
    };
    Arrivals sum;
    for (int i = 0; i < paths; ++i) {
        Rng rng(stream, StreamPurpose::test, static_cast<std::uint64_t>(i));
        Sink sink;
        if (const auto light = emission.sample(rng)) trace_light_path(scene, *light, kDepth, rng, sink, scattering);
        double all = 0;
        for (std::size_t k = 0; k < sum.walls.size(); ++k) {
            sum.walls[k].add(sink.walls[k]);
            all += sink.walls[k];
        }
        sum.paths += all > 0 ? 1 : 0;
    }
    return sum;
}

/// Of each wall, the median of the standard errors that five streams of paths have [W]. `of(stream)`: what arrives.
template <class Of> std::array<double, 4> median_errors(const Of& of) {
    std::array<std::array<double, 5>, 4> errors{};
    for (std::size_t stream = 0; stream < errors[0].size(); ++stream) {
        const Arrivals arrivals = of(stream);
        for (std::size_t k = 0; k < errors.size(); ++k) errors[k][stream] = arrivals.walls[k].standard_error();
    }
    std::array<double, 4> medians{};
    for (std::size_t k = 0; k < errors.size(); ++k) {
        std::ranges::sort(errors[k]);
        medians[k] = errors[k][errors[k].size() / 2];
    }
    return medians;
}

double z_score(const RunningStats& a, const RunningStats& b) {
    return (a.mean() - b.mean()) / std::hypot(a.standard_error(), b.standard_error());
}

class LearnedScatteringOverAYard : public testing::Test {
  protected:
    const std::unique_ptr<Scene> scene = room_over_a_yard();
    const FoundLightPaths found = look_for_light(*scene, {.paths = 32'768, .max_scatterings = kDepth}, {});
    const LearnedEmission emission{*scene, found.ends};
    const LearnedScattering learned{found.scatterings};
};

TEST_F(LearnedScatteringOverAYard, BringsAllPowerByFewerPaths) {
    ASSERT_TRUE(learned.helps());
    constexpr int kPaths = 400'000;
    const Arrivals plain = trace(*scene, emission, ScatterByBsdf(), 4 * kPaths, 1);
    const Arrivals guided = trace(*scene, emission, learned, kPaths, 2);
    for (std::size_t k = 0; k < plain.walls.size(); ++k) {
        EXPECT_LT(std::abs(z_score(plain.walls[k], guided.walls[k])), 4)
            << k << ": " << plain.walls[k].mean() << " " << guided.walls[k].mean();
    }
    // Tails are heavy: the error of one stream, of either kind, may be what a single path makes it.
    const auto plain_errors = median_errors(
        [&](std::uint64_t stream) { return trace(*scene, emission, ScatterByBsdf(), 2 * kPaths, 11 + stream); });
    const auto guided_errors =
        median_errors([&](std::uint64_t stream) { return trace(*scene, emission, learned, kPaths / 2, 21 + stream); });
    for (std::size_t k = 0; k < plain.walls.size(); ++k)
        EXPECT_LT(guided_errors[k], plain_errors[k]) << k << ": of a fourth of the paths";
    EXPECT_GT(guided.paths * 8, 3 * plain.paths); // most come straight to the window in either case

    // Directions whose density is told too large by a fifth would not pass.
    struct Wrong {
        const LearnedScattering& learned;
        std::optional<Continuation> continue_walk(const Vertex& v, const Vec3& to_light, SampleSource& source,
                                                  double& reference) const {
            auto next = learned.continue_walk(v, to_light, source, reference);
            if (next) next->weight /= 1.2;
            return next;
        }
    };
    const Arrivals wrong = trace(*scene, emission, Wrong{learned}, kPaths, 2);
    double most = 0;
    for (std::size_t k = 0; k < plain.walls.size(); ++k)
        most = std::max(most, std::abs(z_score(plain.walls[k], wrong.walls[k])));
    EXPECT_GT(most, 4);
}

TEST_F(LearnedScatteringOverAYard, HasTheDensityOfItsDirections) {
    // A place of the yard; what it sends out integrates to its albedo, whatever chose the direction, and the density
    // that is told is that of the samples.
    Rng rng(3, StreamPurpose::test, 0);
    SurfacePoint eye;
    eye.site = Site::point;
    eye.p = Vec3(1.5f, 0, -2);
    const auto v = next_vertex(*scene, eye, Vec3(0, -1, 0));
    ASSERT_TRUE(v);
    RunningStats albedo, reciprocal;
    int towards_room = 0, plain_towards_room = 0;
    const Vec3 to_light = Vec3(0.3f, 0.9f, -0.3f).normalized();
    constexpr int kSamples = 200'000;
    for (int i = 0; i < kSamples; ++i) {
        double reference = 1;
        const auto next = learned.continue_walk(*v, to_light, rng, reference);
        albedo.add(next ? luminance(next->weight) : 0);
        reciprocal.add(next ? 1 / next->pdf : 0);
        towards_room += next && next->w.z > 0.3f && next->w.y > 0.3f ? 1 : 0;
        if (next) {
            const double bsdf_pdf = scatter(v->point, v->bsdf, Event::finite, to_light, next->w).pdf_to_eye;
            EXPECT_NEAR(reference * next->pdf, bsdf_pdf, 1e-6 * bsdf_pdf);
        }
        const auto plain = continue_walk(*v, to_light, From::light, rng);
        plain_towards_room += plain && plain->w.z > 0.3f && plain->w.y > 0.3f ? 1 : 0;
    }
    EXPECT_TRUE(test::has_mean(albedo, 0.6)) << albedo.mean();
    EXPECT_TRUE(test::has_mean(reciprocal, 2 * kPi)) << reciprocal.mean(); // the hemisphere
    EXPECT_GT(towards_room, 2 * plain_towards_room);
}

TEST(LearnedScattering, LeavesAloneWhatItKnowsNothingOf) {
    const LearnedScattering nothing{std::span<const SeenScattering>()};
    EXPECT_FALSE(nothing.helps());
    // In a box that is lit evenly the BSDF does well.
    const auto box = test::diffuse_box();
    const FoundLightPaths found = look_for_light(*box, {.paths = 8192, .max_scatterings = kDepth}, {});
    ASSERT_GT(found.scatterings.size(), 4096u);
    EXPECT_LT(LearnedScattering(found.scatterings).helped_share(), 0.1);
}

} // namespace
} // namespace keyhole
