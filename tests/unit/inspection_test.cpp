// What keyhole inspect shows is what the render was made from.
#include "core/parallel.h"
#include "methods/inspection/inspection.h"
#include "methods/method.h"
#include "methods/photons/photon_file.h"
#include "sampling/paths/lamps_in_lobes.h"
#include "support/scratch_directory.h"
#include "support/settings_from.h"
#include "support/test_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace keyhole {
namespace {

constexpr InspectionLimits kLimits{
    .photons = 3000, .trails = 500, .importons = 1000, .records = 100, .triangles = 1000, .gather_rays = 2000};

Settings inspected_settings(const Method& method) {
    Settings s =
        test::settings_from("spp=1 light_paths=8k mutations=20k brightness_samples=5k importons=2k max_depth=8");
    s.method = &method;
    return s;
}

class InspectionOf : public testing::TestWithParam<const Method*> {
  protected:
    const Settings settings_ = inspected_settings(*GetParam());
    std::unique_ptr<Scene> scene_ = test::mirror_glass_box();
};

std::string name_of_method(const testing::TestParamInfo<const Method*>& info) { return std::string(info.param->name); }

double power_of(const std::vector<Photon>& photons) {
    double sum = 0;
    for (const Photon& p : photons) sum += luminance(p.power());
    return sum;
}

TEST_P(InspectionOf, PhotonsAreThoseOfTheMap) {
    const ScratchDirectory directory;
    Settings s = settings_;
    s.save_map = directory.path("map");
    s.gather_coverage = false; // of which the file's key knows
    const PhotonSample sample = inspect_scene(*scene_, s, {}, kLimits, {}).photons;
    const Photons map = load_photons(s.save_map, photon_file_key(*scene_, s, nullptr));
    EXPECT_EQ(sample.global.main_photons, map.global.main_photons.size());
    EXPECT_EQ(sample.caustic.main_photons, map.caustic.main_photons.size());
    EXPECT_EQ(sample.global.pilots, map.global.pilots.size());
    EXPECT_DOUBLE_EQ(sample.global.power, power_of(map.global.main_photons));
    EXPECT_DOUBLE_EQ(sample.caustic.power, power_of(map.caustic.main_photons));
    EXPECT_GT(sample.photons.size(), 500u);
    EXPECT_LE(sample.photons.size(), kLimits.photons);
    for (const PhotonShown& p : sample.photons) {
        const auto& all = p.caustic ? map.caustic.main_photons : map.global.main_photons;
        ASSERT_TRUE(std::ranges::find(all, p.photon) != all.end());
    }
}

TEST_P(InspectionOf, TrailsAreTheWaysOfTheirPhotons) {
    const PhotonSample sample = inspect_scene(*scene_, settings_, {}, kLimits, {}).photons;
    ASSERT_GT(sample.trails.size(), 100u);
    EXPECT_LE(sample.trails.size(), kLimits.trails);
    std::size_t drawn = 0, caustics = 0, global_caustics = 0, others = 0;
    for (const PhotonShown& p : sample.photons) {
        ASSERT_GE(p.scatterings, 0);
        if (p.trail < 0) continue;
        ++drawn;
        const PhotonTrail& trail = sample.trails[static_cast<std::size_t>(p.trail)];
        ASSERT_EQ(trail.photon, static_cast<std::size_t>(p.scatterings) + 1);
        ASSERT_LT(trail.photon, trail.points.size());
        EXPECT_EQ(trail.points[trail.photon].p, p.photon.position());
        const Vec3 to_light = (trail.points[trail.photon - 1].p - p.photon.position()).normalized();
        EXPECT_GT(to_light.dot(p.photon.direction()), 0.99999f);
        bool specular = trail.photon > 1; // all vertices before the photon
        for (std::size_t i = 1; i < trail.photon; ++i) specular = specular && trail.points[i].specular;
        SurfacePoint begin;
        begin.p = trail.points[0].p;
        begin.emitter = p.emitter;
        EXPECT_EQ(p.photon.caustic(), specular && (!p.caustic || is_large_lamp(*scene_, begin)));
        (p.caustic ? caustics : p.photon.caustic() ? global_caustics : others) += 1;
        EXPECT_EQ(p.emitter, 0u);
        EXPECT_NEAR(trail.points[0].p.y, scene_->emitter(0).bounds()->lower.y, 1e-4);
        for (std::size_t i = 0; i + 1 < trail.points.size(); ++i) { // nothing stands between
            const Vec3 a = trail.points[i].p, b = trail.points[i + 1].p;
            EXPECT_TRUE(scene_->visible(a + (b - a) * 0.001f, b + (a - b) * 0.001f)) << i;
        }
    }
    EXPECT_EQ(drawn, sample.trails.size());
    EXPECT_GT(caustics, 0u);
    EXPECT_GT(global_caustics, 0u);
    EXPECT_GT(others, 0u);
}

TEST_P(InspectionOf, IsTheSameOnAnyNumberOfThreads) {
    Inspection one, four;
    with_threads(1, [&] { one = inspect_scene(*scene_, settings_, {}, kLimits, {}); });
    with_threads(4, [&] { four = inspect_scene(*scene_, settings_, {}, kLimits, {}); });
    EXPECT_EQ(one.photons.trails, four.photons.trails);
    EXPECT_EQ(one.photons.refused, four.photons.refused);
    EXPECT_EQ(one.photons.refused_at, four.photons.refused_at);
    ASSERT_EQ(one.pixels.size(), four.pixels.size());
    for (std::size_t i = 0; i < one.pixels.size(); ++i) {
        EXPECT_EQ(one.pixels[i].trail, four.pixels[i].trail);
        EXPECT_EQ(one.pixels[i].reach, four.pixels[i].reach);
    }
    EXPECT_EQ(one.render.picture.layers.at("beauty").data, four.render.picture.layers.at("beauty").data);
}

/// To be watched changes nothing.
TEST_P(InspectionOf, PictureIsThatOfTheRender) {
    const Inspection inspection = inspect_scene(*scene_, settings_, {}, kLimits, {});
    const RenderResult plain = render(*scene_, settings_, {});
    EXPECT_EQ(inspection.render.picture.layers.at("beauty").data, plain.picture.layers.at("beauty").data);
    EXPECT_NE(inspection.again.picture.layers.at("beauty").data, plain.picture.layers.at("beauty").data);
}

INSTANTIATE_TEST_SUITE_P(Methods, InspectionOf, testing::Values(&methods::ipm, &methods::pm, &methods::mps),
                         name_of_method);

TEST(Inspection, PathsOfChainsGoOnToTheEye) {
    const auto scene = test::diffuse_box();
    const PhotonSample sample = inspect_scene(*scene, inspected_settings(methods::mps), {}, kLimits, {}).photons;
    ASSERT_FALSE(sample.trails.empty());
    for (const PhotonTrail& trail : sample.trails)
        EXPECT_EQ(trail.points.back().p, scene->camera().parameters().origin);
}

TEST(Inspection, PixelsSeeWhatTheCameraSees) {
    const auto scene = test::diffuse_box();
    const Inspection inspection = inspect_scene(*scene, inspected_settings(methods::ipm), {}, kLimits, {});
    const ImageWindow& window = scene->camera().window();
    ASSERT_EQ(inspection.pixels.size(), static_cast<std::size_t>(window.width * window.height));
    const float lamp = scene->emitter(0).bounds()->lower.y;
    std::size_t lit = 0;
    for (int i = 0; i < window.width * window.height; ++i) {
        const PixelLight& pixel = inspection.pixels[static_cast<std::size_t>(i)];
        const Vec2 middle(static_cast<float>(i % window.width) + 0.5f, static_cast<float>(i / window.width) + 0.5f);
        const SurfacePoint eye = scene->camera().eye(0.5, 0.5);
        const auto seen = scene->trace(eye, scene->camera().ray_direction(eye, window.to_window(middle)));
        ASSERT_TRUE(seen && pixel.seen);
        EXPECT_EQ(pixel.trail.back(), seen->p);
        const auto in_sight = [&](const PixelLight::Source& source) {
            const Vec3 way = source.p - seen->p;
            return !(source.value > 0) || scene->visible(seen->p + way * 0.001f, source.p - way * 0.001f);
        };
        EXPECT_TRUE(std::ranges::all_of(pixel.direct, in_sight));
        EXPECT_TRUE(std::ranges::all_of(pixel.gather, in_sight));
        EXPECT_TRUE(std::ranges::all_of(pixel.gather, [&](const PixelLight::GatherEnd& end) {
            return !(end.from_lamp > 0) || std::abs(end.lamp.y - lamp) < 1e-4f;
        }));
        for (const auto& source : pixel.direct) {
            if (!(source.value > 0)) continue;
            EXPECT_NEAR(source.p.y, lamp, 1e-4);
            ++lit;
        }
    }
    EXPECT_GT(lit, inspection.pixels.size());
}

/// Two lamps, of which the second is the stronger.
TEST(Inspection, PixelsTellTheChancesOfLamps) {
    test::SceneMaker m;
    const auto wall = make_diffuse(Rgb(0.5));
    m.room({-2, 0, -1}, {2, 1, 1}, wall);
    m.rectangle({-1.5f, 0.99f, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}, wall, Rgb(1));
    m.rectangle({1.3f, 0.99f, -0.1f}, {0.2f, 0, 0}, {0, 0, 0.2f}, wall, Rgb(5));
    m.camera({0, 0.5f, 0.9f}, {0, 0, -0.3f}, 90).window(32, 24);
    const auto scene = m.build();
    const Inspection inspection = inspect_scene(*scene, inspected_settings(methods::ipm), {}, kLimits, {});
    EXPECT_FALSE(inspection.learned_direct_light);
    for (int i = 0; i < 32 * 24; ++i) {
        const PixelLight& pixel = inspection.pixels[static_cast<std::size_t>(i)];
        const ImageWindow& window = scene->camera().window();
        const SurfacePoint eye = scene->camera().eye(0.5, 0.5);
        const Vec2 middle(static_cast<float>(i % 32) + 0.5f, static_cast<float>(i / 32) + 0.5f);
        const auto seen = scene->trace(eye, scene->camera().ray_direction(eye, window.to_window(middle)));
        ASSERT_TRUE(seen && pixel.seen && pixel.lamps.size() == 2);
        EXPECT_GE(pixel.lamps[0].probability, pixel.lamps[1].probability);
        for (const EmitterChance& lamp : pixel.lamps)
            EXPECT_EQ(lamp.probability, scene->light_tree().probability(*seen, lamp.emitter));
    }
    const PixelLight& right = inspection.pixels[20 * 32 + 29];
    EXPECT_EQ(right.lamps[0].emitter, 1u);
    EXPECT_GT(right.lamps[0].probability, 0.6);
}

/// In test::two_rooms() the eye is where z > 0, the lamp beyond the partition.
TEST(Inspection, PhotonsAreToldFromThoseBeyondGatherRays) {
    const auto scene = test::two_rooms(0.01f);
    const Inspection inspection = inspect_scene(*scene, inspected_settings(methods::ipm), {}, kLimits, {});
    EXPECT_FALSE(inspection.gathered_everywhere);
    std::size_t beyond = 0;
    for (const PhotonShown& p : inspection.photons.photons) {
        const float z = p.photon.position().z;
        EXPECT_FALSE(z < -0.5f && p.gathered) << z;
        EXPECT_FALSE(z > 0.5f && !p.gathered) << z;
        EXPECT_TRUE(p.gathered || p.caustic) << z;
        beyond += p.gathered ? 0 : 1;
    }
    EXPECT_GT(beyond, 100u);
}

TEST(Inspection, WarningsSayWhatTheyAreAbout) {
    const auto scene = test::diffuse_box();
    Settings s = inspected_settings(methods::ipm);
    s.light_paths = 50;
    const RenderStats stats = inspect_scene(*scene, s, {}, kLimits, {}).render.stats;
    ASSERT_FALSE(stats.warnings.empty());
    for (const std::string& warning : stats.warnings) EXPECT_TRUE(stats.doubts.contains(warning)) << warning;
}

TEST(Inspection, MeshesAreSimplifiedToWhatIsAskedFor) {
    TriangleMesh mesh;
    constexpr std::uint32_t kSide = 120;
    for (std::uint32_t y = 0; y <= kSide; ++y)
        for (std::uint32_t x = 0; x <= kSide; ++x)
            mesh.positions.emplace_back(static_cast<float>(x) / kSide, static_cast<float>(y) / kSide, 0.0f);
    for (std::uint32_t y = 0; y < kSide; ++y)
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const std::uint32_t a = y * (kSide + 1) + x, b = a + kSide + 1;
            mesh.triangles.push_back({a, a + 1, b});
            mesh.triangles.push_back({a + 1, b + 1, b});
        }
    SceneDescription d;
    Shape shape;
    shape.geometry = mesh;
    shape.material = make_diffuse(Rgb(0.5));
    d.shapes.push_back(std::move(shape));
    const Scene scene(std::move(d));
    const SurfaceMesh simple = surface_mesh(scene, 2000);
    EXPECT_EQ(simple.of_scene, 2u * kSide * kSide);
    EXPECT_LE(simple.triangles.size(), 2000u);
    EXPECT_GT(simple.triangles.size(), 500u);
    double area = 0;
    for (const auto& t : simple.triangles)
        area += (simple.positions[t[1]] - simple.positions[t[0]])
                    .cross(simple.positions[t[2]] - simple.positions[t[0]])
                    .length() /
                2;
    EXPECT_NEAR(area, 1, 0.06);
    EXPECT_EQ(surface_mesh(scene, 100'000).triangles.size(), simple.of_scene);
}

TEST(Inspection, MethodsWithoutPhotonsAreRefused) {
    const auto scene = test::diffuse_box();
    EXPECT_THROW(inspect_scene(*scene, inspected_settings(methods::path), {}, kLimits, {}), InputError);
}

} // namespace
} // namespace keyhole
