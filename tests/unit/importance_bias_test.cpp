// What density estimation of importance does to photon power, by wall: `marginal` divides by it.
#include "core/statistics.h"
#include "photonmap/importance/importance_map.h"
#include "photonmap/importance/importance_tracing.h"
#include "sampling/paths/light_tracer.h"
#include "sampling/paths/measure.h"
#include "sampling/paths/walk.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <array>

namespace keyhole {
namespace {

constexpr int kDepth = 8;
constexpr std::size_t kWalls = 6;

std::size_t wall(const Scene& scene, const Vec3& p) {
    for (int k = 0; k < 3; ++k) {
        if (std::abs(p[k] - scene.lower()[k]) < 1e-3f) return static_cast<std::size_t>(2 * k);
        if (std::abs(p[k] - scene.upper()[k]) < 1e-3f) return static_cast<std::size_t>(2 * k + 1);
    }
    return kWalls;
}

/// An unbiased estimate of Y(power E): a walk from d2, joined to the eye at its first vertex. For diffuse scenes.
double visible_power(const Scene& scene, const Vertex& d2, const Vec3& to_light, const Rgb& power, Rng& rng) {
    const Vertex eye = sample_eye(scene, rng);
    const auto on = continue_walk(d2, to_light, From::light, rng);
    const auto d1 = on ? next_vertex(scene, d2, on->w) : std::nullopt;
    if (!d1 || d1->point.site != Site::surface) return 0;
    const Vec3 to_eye = direction(d1->point, eye.point);
    if (!scene.camera().image_point(eye.point, -to_eye) || !scene.visible(d1->point, eye.point)) return 0;
    return luminance(power * on->weight * scatter(d1->point, d1->bsdf, Event::finite, -on->w, to_eye).value) *
           solid_angle_to_area(scene.camera().direction_pdf(-to_eye), eye.point, d1->point);
}

/// Chains leave photons in proportion to Y(power E) and give each a power of 1 / estimate of that: the power of a wall
/// comes out wrong by the mean of Y(power E) / estimate - 1, weighted by power. Here with photons of light tracing, and
/// E by walks.
struct Bias {
    std::array<RunningStats, kWalls> power;     ///< of the light that arrives
    std::array<RunningStats, kWalls> undivided; ///< error if every photon's power were divided by E
    std::array<RunningStats, kWalls> trusted;   ///< error if those are that are; the rest have the right expectation
};

class BiasSink {
  public:
    BiasSink(const Scene& scene, const ImportanceMap& map, Rng& walks) : scene_(scene), map_(map), walks_(walks) {}

    bool arrival(const Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast&) {
        const std::size_t w = wall(scene_, v.point.p);
        if (arrivals_ > 0 && arrivals_ < kDepth - 1 && w < kWalls) add(w, v, to_light, power);
        return ++arrivals_ < kDepth;
    }
    void leave(Bias& bias) const {
        for (std::size_t w = 0; w < kWalls; ++w) {
            bias.power[w].add(power_[w]);
            bias.undivided[w].add(undivided_[w]);
            bias.trusted[w].add(trusted_[w]);
        }
    }

  private:
    void add(std::size_t w, const Vertex& v, const Vec3& to_light, const Rgb& power) {
        power_[w] += luminance(power);
        const auto e = map_.importance(v.point, v.bsdf, to_light);
        const double estimate = luminance(power * e.value);
        if (!(estimate > 0)) return;
        constexpr int kWalks = 8;
        double truth = 0;
        for (int i = 0; i < kWalks; ++i) truth += visible_power(scene_, v, to_light, power, walks_) / kWalks;
        const double error = luminance(power) * (truth / estimate - 1);
        undivided_[w] += error;
        if (e.trusted(v.bsdf)) trusted_[w] += error;
    }

    const Scene& scene_;
    const ImportanceMap& map_;
    Rng& walks_;
    std::array<double, kWalls> power_{}, undivided_{}, trusted_{};
    int arrivals_ = 0;
};

Bias measure_bias(const Scene& scene, std::int64_t importons) {
    const SurfacePatches patches(scene);
    Importons traced =
        trace_importance(scene, {.samples = importons, .at_d1 = false, .max_scatterings = kDepth, .seed = 5}, {});
    const ImportanceMap map(std::move(traced.second), {.max_radius = 0.5f, .patches = &patches});
    Bias bias;
    for (std::uint64_t i = 0; i < 30'000; ++i) {
        Rng rng(3, StreamPurpose::test, i), walks(4, StreamPurpose::test, i);
        BiasSink sink(scene, map, walks);
        trace_light_path(scene, kDepth, rng, sink);
        sink.leave(bias);
    }
    return bias;
}

/// Mean squared relative error over walls, less what noise adds to it.
double squared_error(const std::array<RunningStats, kWalls>& errors, const Bias& bias) {
    double sum = 0;
    for (std::size_t w = 0; w < kWalls; ++w) {
        const double power = bias.power[w].mean();
        sum += (errors[w].mean() * errors[w].mean() - errors[w].standard_error() * errors[w].standard_error()) /
               (power * power * kWalls);
    }
    return sum;
}

TEST(ImportanceBias, FallsWithTheNumberOfImportons) {
    const auto scene = test::two_rooms(0.5f);
    const Bias few = measure_bias(*scene, 10'000), many = measure_bias(*scene, 300'000);
    const double before = squared_error(few.undivided, few), after = squared_error(many.undivided, many);
    RecordProperty("rms_with_10k_importons", std::to_string(std::sqrt(std::max(0.0, before))));
    RecordProperty("rms_with_300k_importons", std::to_string(std::sqrt(std::max(0.0, after))));
    EXPECT_GT(before, 0.1 * 0.1);
    EXPECT_LT(after, before / 4);
}

TEST(ImportanceBias, IsBelowTwoPercentWhereItIsTrusted) {
    const auto scene = test::diffuse_box();
    const Bias bias = measure_bias(*scene, 300'000);
    for (std::size_t w = 0; w < kWalls; ++w) {
        const double power = bias.power[w].mean(), error = bias.trusted[w].standard_error() / power;
        RecordProperty("wall_" + std::to_string(w), std::to_string(bias.trusted[w].mean() / power));
        EXPECT_TRUE(test::has_mean(bias.trusted[w], 0, kWalls, 0.02 * power)) << "wall " << w;
        EXPECT_LT(error, 0.03) << "the test says nothing of wall " << w;
    }
}

} // namespace
} // namespace keyhole
