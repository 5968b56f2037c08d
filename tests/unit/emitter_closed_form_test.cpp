// Light of every kind of emitter against what one can calculate.
#include "core/statistics.h"
#include "sampling/paths/path_tracer.h"
#include "scene/emitters/emitters.h"
#include "support/chance.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace keyhole {
namespace {

using test::SceneMaker;

/// A white floor at y = 0 around the origin, seen from (0, 0.5, 0).
SceneMaker white_floor() {
    SceneMaker m;
    m.rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, make_diffuse(Rgb(1.0))).camera({0, 0.5f, 0.01f}, {0, 0, 0}, 40);
    return m;
}

/// The place of the floor below (x, 0.1, z), and the direction up from it.
Vertex floor_vertex(const Scene& scene, float x = 0, float z = 0) {
    SurfacePoint above;
    above.site = Site::point;
    above.p = Vec3(x, 0.1f, z);
    return next_vertex(scene, above, Vec3(0, -1, 0)).value();
}
const Vec3 kUp(0, 1, 0);

struct Estimates {
    RunningStats combined; ///< light sampling and BSDF sampling together
    RunningStats by_bsdf;  ///< BSDF sampling alone
};

/// Irradiance from emitters at a white diffuse vertex: pi times the radiance that it reflects.
Estimates irradiance(const Scene& scene, Vertex v, int samples) {
    Estimates e;
    Rng rng(5, StreamPurpose::test, 0);
    v.event = Event::finite;
    for (int i = 0; i < samples; ++i) {
        Rgb combined(0.0), alone(0.0);
        const auto light = sample_direct_light(scene, v, kUp, rng);
        if (light && scene.visible(v.point, light->x0.point)) combined += light->value;
        const auto next = continue_walk(v, kUp, From::eye, rng);
        const auto hit = next ? next_vertex(scene, v, next->w) : std::nullopt;
        if (hit && hit->point.is_emitter()) {
            const Rgb arrived = next->weight * scene.transmittance(v.point, hit->point);
            combined += arrived * emission_with_mis(scene, v, *hit, next->w, next->pdf);
            alone += arrived * scene.emitter(hit->point.emitter).radiance(hit->point, -next->w);
        }
        e.combined.add(luminance(combined) * kPi);
        e.by_bsdf.add(luminance(alone) * kPi);
    }
    return e;
}

void expect_mean(const RunningStats& stats, double value) {
    EXPECT_TRUE(test::has_mean(stats, value, 1, 1e-5 * value));
    EXPECT_LT(stats.standard_error(), 0.02 * value) << "too noisy to tell";
}

TEST(EmitterClosedForm_PointLight, IlluminatesAPlaneByCosineOverDistanceSquared) {
    SceneMaker m = white_floor();
    m.emitter(make_point_emitter({0.3f, 2, 0.4f}, Rgb(5.0)));
    const auto scene = m.build();
    const double r2 = 0.09 + 4 + 0.16;
    expect_mean(irradiance(*scene, floor_vertex(*scene), 4).combined, 5 * (2 / std::sqrt(r2)) / r2);
}

TEST(EmitterClosedForm_SpotLight, IsAPointLightInsideAndDarkOutside) {
    SceneMaker m = white_floor();
    m.emitter(make_spot_emitter(
        {.position = {0, 2, 0}, .axis = {0, -1, 0}, .intensity = Rgb(5.0), .full_degrees = 10, .edge_degrees = 20}));
    const auto scene = m.build();
    expect_mean(irradiance(*scene, floor_vertex(*scene), 4).combined, 5.0 / 4);
    const double cosine = (std::cos(10 * kPi / 180) + std::cos(20 * kPi / 180)) / 2; // half dark by smoothstep
    const auto x = static_cast<float>(2 * std::tan(std::acos(cosine)));
    expect_mean(irradiance(*scene, floor_vertex(*scene, x), 4).combined, 2.5 * std::pow(cosine, 3) / 4);
    EXPECT_EQ(irradiance(*scene, floor_vertex(*scene, 0.8f), 4).combined.mean(), 0);
    EXPECT_NEAR(scene->emitter(0).power(), 5 * kPi * (2 - std::cos(10 * kPi / 180) - std::cos(20 * kPi / 180)), 1e-9);
}

TEST(EmitterClosedForm_SpotLight, IsHalfDarkBetweenTheConesHoweverNarrow) {
    for (const double edge : {1.0, 0.1, 0.01}) {
        SCOPED_TRACE(edge);
        SceneMaker m = white_floor();
        m.emitter(make_spot_emitter({.position = {0, 2, 0},
                                     .axis = {0, -1, 0},
                                     .intensity = Rgb(5.0),
                                     .full_degrees = edge / 2,
                                     .edge_degrees = edge}));
        const auto scene = m.build();
        // Of narrow cones cosines go as squares of angles.
        const auto x = static_cast<float>(2 * std::tan(std::sqrt((1 + 0.25) / 2) * edge * kPi / 180));
        EXPECT_NEAR(irradiance(*scene, floor_vertex(*scene, x), 4).combined.mean(), 2.5 / 4, 0.02 * 2.5 / 4);
    }
}

/// Light that fades as glTF's: by the square of the share of the way between the cosines.
TEST(EmitterClosedForm_SpotLight, FadesBySquares) {
    const SpotParameters spot{.position = {0, 2, 0},
                              .axis = {0, -1, 0},
                              .intensity = Rgb(5.0),
                              .full_degrees = 10,
                              .edge_degrees = 30,
                              .fade = SpotFade::squared};
    SceneMaker m = white_floor();
    m.emitter(make_spot_emitter(spot));
    const auto scene = m.build();
    const double full = std::cos(10 * kPi / 180), edge = std::cos(30 * kPi / 180), third = edge + (full - edge) / 3;
    const auto x = static_cast<float>(2 * std::tan(std::acos(third)));
    expect_mean(irradiance(*scene, floor_vertex(*scene, x), 4).combined, 5.0 / 9 * std::pow(third, 3) / 4);
    EXPECT_NEAR(spot_solid_angle(spot), scene->emitter(0).power() / 5, 1e-9);
}

/// Power and density against numerical integration, and what is drawn against the density.
TEST(EmitterClosedForm_SpotLight, IsDrawnAsItFades) {
    constexpr int kBins = 20, kSteps = 2000, kSamples = 40000;
    for (const SpotFade fade : {SpotFade::smooth, SpotFade::squared}) {
        const auto e = make_spot_emitter(
            {.axis = {0, 0, 1}, .intensity = Rgb(5.0), .full_degrees = 20, .edge_degrees = 70, .fade = fade});
        Rng rng(3, StreamPurpose::test, 0);
        const SurfacePoint point = e->sample_point(rng).point;
        std::array<double, kBins> expected{}, found{};
        const auto bin = [](double cosine) { return std::min(static_cast<int>(cosine * kBins), kBins - 1); };
        double power = 0;
        for (int i = 0; i < kBins * kSteps; ++i) {
            const double cosine = (i + 0.5) / (kBins * kSteps), ring = 2 * kPi / (kBins * kSteps);
            const Vec3 w(static_cast<float>(std::sqrt(1 - cosine * cosine)), 0, static_cast<float>(cosine));
            expected[bin(cosine)] += e->ray_pdf(point, w) * ring;
            power += luminance(e->radiance(point, w)) * ring;
        }
        for (int i = 0; i < kSamples; ++i) found[bin(e->sample_ray(point, rng).w.z)] += 1.0 / kSamples;
        EXPECT_NEAR(e->power(), power, 1e-4 * power);
        EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), 1, 1e-4);
        for (int i = 0; i < kBins; ++i)
            EXPECT_NEAR(found[i], expected[i], 5 * std::sqrt(expected[i] / kSamples) + 1e-5);
    }
}

TEST(EmitterClosedForm_DistantLight, GivesIrradianceTimesCosine) {
    SceneMaker m = white_floor();
    const Vec3 w = Vec3(1, -2, 0.5f).normalized();
    m.emitter(make_distant_emitter(w, Rgb(3.0)));
    const auto scene = m.build();
    expect_mean(irradiance(*scene, floor_vertex(*scene), 4).combined, 3.0 * -w.y);
    expect_mean(irradiance(*scene, floor_vertex(*scene, 0.9f, -0.9f), 4).combined, 3.0 * -w.y);
}

TEST(EmitterClosedForm_ConstantEnvironments, AddUpToPiTimesTheirRadiance) {
    SceneMaker m = white_floor();
    m.emitter(make_constant_environment(Rgb(0.5))).emitter(make_constant_environment(Rgb(1.5)));
    const auto scene = m.build();
    ASSERT_EQ(scene->emitters().size(), 1u);
    const Estimates e = irradiance(*scene, floor_vertex(*scene), 20'000);
    expect_mean(e.combined, 2 * kPi);
    expect_mean(e.by_bsdf, 2 * kPi);
}

/// Adds up all light of a path.
struct Sum {
    double value = 0;
    bool arrival(const EyeWalk&, const Rgb&, int) const { return true; }
    void contribution(const EyeWalk&, const Vertex&, const Rgb& v, LightClass) { value += luminance(v); }
};

RunningStats mean_radiance(const Scene& scene, int samples) {
    RunningStats stats;
    Rng rng(6, StreamPurpose::test, 0);
    for (int i = 0; i < samples; ++i) {
        Sum sum;
        const auto x = static_cast<float>(rng.next()), y = static_cast<float>(rng.next());
        trace_path(scene, {x, y}, 20, rng, sum);
        stats.add(sum.value);
    }
    return stats;
}

TEST(EmitterClosedForm_OpenFurnace, AWhiteBallIsInvisible) {
    SceneMaker m;
    m.sphere({0, 0, 0}, 1, make_diffuse(Rgb(1.0))).emitter(make_constant_environment(Rgb(1.0)));
    m.camera({0, 0, 4}, {0, 0, 0}, 35);
    expect_mean(mean_radiance(*m.build(), 20'000), 1);
}

TEST(EmitterClosedForm_OpenFurnace, AGlassBallIsInvisible) {
    SceneMaker m;
    m.sphere({0, 0, 0}, 1, make_glass(1.5)).emitter(make_constant_environment(Rgb(1.0)));
    m.camera({0, 0, 4}, {0, 0, 0}, 35);
    const RunningStats stats = mean_radiance(*m.build(), 20'000);
    EXPECT_NEAR(stats.mean(), 1, 0.002) << "but for light that stays inside past the last vertex";
}

/// Form factor from an element to a parallel rectangle a x b, one of whose corners is above it at distance 1.
double corner_form_factor(double a, double b) {
    const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
    return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * kPi);
}

TEST(EmitterClosedForm_Rectangle, MatchesItsFormFactor) {
    SceneMaker m = white_floor();
    m.rectangle({-0.5f, 1, -0.3f}, {1.2f, 0, 0}, {0, 0, 0.8f}, make_diffuse(Rgb(0.0)), Rgb(2.0));
    const auto scene = m.build();
    const double f = corner_form_factor(0.5, 0.3) + corner_form_factor(0.7, 0.3) + corner_form_factor(0.5, 0.5) +
                     corner_form_factor(0.7, 0.5);
    const Estimates e = irradiance(*scene, floor_vertex(*scene), 60'000);
    expect_mean(e.combined, 2 * kPi * f);
    expect_mean(e.by_bsdf, 2 * kPi * f);
}

TEST(EmitterClosedForm_ManyEmitters, AddUp) {
    SceneMaker m = white_floor();
    m.rectangle({-0.5f, 1, -0.5f}, {1, 0, 0}, {0, 0, 1}, make_diffuse(Rgb(0.0)), Rgb(2.0));
    m.emitter(make_point_emitter({3, 0.5f, 0}, Rgb(40.0))).emitter(make_point_emitter({-0.4f, 0.2f, 0}, Rgb(0.05)));
    m.emitter(make_distant_emitter({0, -1, 0}, Rgb(0.0))); // brings nothing
    m.emitter(make_distant_emitter(Vec3(1, -0.2f, 0).normalized(), Rgb(1.0)));
    const auto scene = m.build();
    const auto point = [](double intensity, double h, double r2) { return intensity * h / (r2 * std::sqrt(r2)); };
    const double expected = 2 * kPi * 4 * corner_form_factor(0.5, 0.5) + point(40, 0.5, 9.25) + point(0.05, 0.2, 0.2) +
                            0.2 / std::sqrt(1.04);
    expect_mean(irradiance(*scene, floor_vertex(*scene), 60'000).combined, expected);
}

} // namespace
} // namespace keyhole
