// What is said of pictures that are black, or nearly so.
#include "methods/enclosure.h"
#include "methods/method.h"
#include "methods/sample_report.h"
#include "scene/emitters/emitters.h"
#include "scene/textures/function_texture.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace keyhole {
namespace {

using test::SceneMaker;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

RenderResult rendered(Scene& scene, const char* method) {
    Settings settings = test::settings_from("spp=4");
    settings.method = &method_named(method);
    return render(scene, settings, {});
}

double mean_of(const Picture& picture) {
    const Image& image = picture.layers.at("beauty");
    return std::accumulate(image.data.begin(), image.data.end(), 0.0) / static_cast<double>(image.data.size());
}

/// A floor in the sun, seen from under a pane: of eye and light sub-paths only the latter bring any light.
TEST(BlackPictures, AreNotThoseThatLightPathsAloneDraw) {
    SceneMaker m;
    m.rectangle({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, make_diffuse(Rgb(0.5)));
    m.rectangle({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}, make_thin_dielectric(1.5));
    m.emitter(make_distant_emitter({0, -1, 0}, Rgb(20.0)));
    const auto scene = m.camera({0, 0.9f, 0.01f}, {0, 0, 0}, 50).window(8, 6).build();
    const RenderResult result = rendered(*scene, "bdpt");
    EXPECT_GT(mean_of(result.picture), 1);
    EXPECT_THAT(result.stats.warnings, Not(Contains(HasSubstr("picture is black"))));
}

/// A varnished floor under a pane, in a sun of a width in degrees.
std::unique_ptr<Scene> varnish_behind_glass(double sun, const MaterialPtr& pane) {
    SceneMaker m;
    m.rectangle({-1, 0, 1}, {2, 0, 0}, {0, 0, -2},
                make_conductor(Rgb(1.5), Rgb(4.0), constant_texture(0.2), constant_texture(0.2)));
    m.rectangle({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}, pane);
    m.emitter(make_distant_emitter({0, -1, 0}, Rgb(20.0), sun));
    return m.camera({0, 0.9f, 0.01f}, {0, 0, 0}, 50).window(8, 6).build();
}

/// Only path looks through the pane.
TEST(LostCaustics, AreSaidByWhatTheMethodDoes) {
    for (const double sun : {0.0, 0.53}) {
        const auto scene = varnish_behind_glass(sun, make_thin_dielectric(1.5));
        const auto by_path = rendered(*scene, "path").stats.warnings, by_bdpt = rendered(*scene, "bdpt").stats.warnings;
        EXPECT_THAT(by_bdpt, Contains(HasSubstr("the sun shines in through clear glass"))) << sun;
        EXPECT_THAT(by_path, Not(Contains(HasSubstr("the sun shines in")))) << sun;
        EXPECT_THAT(by_path, Not(Contains(HasSubstr("joined to the eye")))) << sun;
        if (sun == 0) {
            EXPECT_THAT(by_path, Contains(HasSubstr("but for what comes straight through clear glass")));
        }
    }
    const auto open = varnish_behind_glass(0.53, make_diffuse(Rgb(0.5)));
    EXPECT_THAT(rendered(*open, "bdpt").stats.warnings, Not(Contains(HasSubstr("the sun shines in"))));
}

/// Advice is what can be followed: photons aren't to be had where a medium scatters.
TEST(LostCaustics, AreSaidToNeedPhotonsWhereThereMayBeSome) {
    for (const bool foggy : {false, true}) {
        SceneMaker m;
        m.sphere({0, 0, 0}, 0.5f, make_glass(1.5)).emitter(make_distant_emitter({0, -1, 0}, Rgb(2.0)));
        if (foggy) m.medium(std::make_shared<const Medium>(Medium{Rgb(0.0), Rgb(0.1), 0.5f}));
        const auto scene = m.camera({0, 0, 3}, {0, 0, 0}, 40).window(8, 6).build();
        RenderStats stats;
        report_lost_caustics(*scene, stats);
        ASSERT_EQ(stats.warnings.size(), 1u) << foggy;
        EXPECT_EQ(testing::Value(stats.warnings[0], HasSubstr("such as ipm's")), !foggy) << stats.warnings[0];
        EXPECT_EQ(testing::Value(stats.warnings[0], HasSubstr("some extent")), foggy) << stats.warnings[0];
    }
}

/// Warnings of light that methods lose, for a lamp and a ball of glass within walls or outside.
std::size_t losses(const Vec3& glass, float radius, std::unique_ptr<Emitter> lamp, const MaterialPtr& walls) {
    SceneMaker m;
    m.box({-1, -1, -1}, {1, 1, 1}, walls).sphere(glass, radius, make_glass(1.5)).emitter(std::move(lamp));
    const auto scene = m.camera({0, 0, 0.9f}, {0, 0, 0}, 40).window(8, 6).build();
    RenderStats stats;
    report_lost_caustics(*scene, stats);
    return stats.warnings.size();
}

/// Nobody misses light that no specular surface gets, such as that of a sun outside closed walls.
TEST(LostCaustics, AreThoseOfLightThatMeetsSpecularSurfaces) {
    const MaterialPtr white = make_diffuse(Rgb(0.5));
    const auto sun = [] { return make_distant_emitter({0, -1, 0}, Rgb(2.0)); };
    EXPECT_EQ(losses({0, 0, 0}, 0.3f, sun(), white), 0u);
    EXPECT_EQ(losses({0, 0, 0}, 0.3f, make_point_emitter({0, 3, 0}, Rgb(1.0)), white), 0u);
    EXPECT_EQ(losses({0, 2, 0}, 0.3f, sun(), white), 1u);
    EXPECT_EQ(losses({0, 0, 0}, 0.3f, make_point_emitter({0, 0.9f, 0}, Rgb(1.0)), white), 1u);
    EXPECT_EQ(losses({1.5f, 0, 0}, 1e-3f, sun(), white), 1u) << "a pearl that hardly a ray meets";
    EXPECT_EQ(losses({0, 0, 0}, 0.3f, sun(), make_interface()), 1u);
    const auto mirrors = [&](double share) {
        return make_mix(white, make_mirror(Rgb(0.9)),
                        function_texture<double>([=](const SurfacePoint&) { return share; }));
    };
    EXPECT_EQ(losses({0, 0, 0}, 0.3f, sun(), mirrors(0)), 0u) << "what might be a mirror, but nowhere is";
    EXPECT_EQ(losses({0, 0, 0}, 0.3f, sun(), mirrors(0.1)), 1u);
}

/// Its mirror is not there.
TEST(LostCaustics, AreNotThoseOfAnAreaLightWithoutASurface) {
    SceneMaker m;
    m.rectangle({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, make_diffuse(Rgb(0.5)));
    m.rectangle({-0.3f, 1, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, make_mirror(Rgb(0.9)), Rgb(20.0)).alpha(0);
    m.emitter(make_point_emitter({0, 2, 0}, Rgb(1.0)));
    const auto scene = m.camera({0, 1, 3}, {0, 0, 0}, 42).window(8, 6).build();
    EXPECT_THAT(rendered(*scene, "path").stats.warnings, Not(Contains(HasSubstr("without extent"))));
}

/// A lit floor, and a box.
SceneMaker lit_floor(const Vec3& lower, const Vec3& upper, const MaterialPtr& box) {
    SceneMaker m;
    m.rectangle({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, make_diffuse(Rgb(0.5)));
    m.rectangle({-0.3f, 2, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, make_black(), Rgb(20.0));
    m.box(lower, upper, box).camera({0, 1, 3}, {0, 0, 0}, 42).window(8, 6);
    return m;
}

TEST(BlackPictures, OfAWalledInCameraAreExplained) {
    const auto scene = lit_floor({-0.2f, 0.8f, 2.8f}, {0.2f, 1.2f, 3.2f}, make_diffuse(Rgb(0.7))).build();
    EXPECT_EQ(dark_enclosure(*scene), &scene->shapes().at(2));
    for (const char* method : {"path", "bdpt", "ipm"}) {
        const RenderStats stats = rendered(*scene, method).stats;
        EXPECT_THAT(stats.warnings, Contains(HasSubstr("the camera stands within a closed shape"))) << method;
        EXPECT_THAT(stats.warnings, Not(Contains(HasSubstr("try")))) << method;
    }
}

TEST(BlackPictures, WallsThatLetLightInOrHoldALampAreNone) {
    const Vec3 lower(-0.2f, 0.8f, 2.8f), upper(0.2f, 1.2f, 3.2f);
    const MaterialPtr white = make_diffuse(Rgb(0.7));
    EXPECT_EQ(dark_enclosure(*lit_floor(lower, upper, make_glass(1.5)).build()), nullptr);
    EXPECT_EQ(dark_enclosure(*lit_floor(lower, upper, make_interface()).build()), nullptr);
    EXPECT_EQ(dark_enclosure(*lit_floor(lower, {0.2f, 0.95f, 3.2f}, white).build()), nullptr) << "beside the camera";
    EXPECT_EQ(dark_enclosure(*lit_floor({-2, -1, -2}, {2, 3, 4}, white).build()), nullptr) << "lit within";
    EXPECT_EQ(dark_enclosure(*lit_floor(lower, upper, white).alpha(0.5).build()), nullptr);
    SceneMaker sky = lit_floor(lower, upper, white);
    EXPECT_NE(dark_enclosure(*sky.emitter(make_constant_environment(Rgb(1.0))).build()), nullptr);
    SceneMaker lamp = lit_floor(lower, upper, white);
    EXPECT_EQ(dark_enclosure(*lamp.emitter(make_point_emitter({0.1f, 1, 3}, Rgb(1.0))).build()), nullptr);
}

} // namespace
} // namespace keyhole
