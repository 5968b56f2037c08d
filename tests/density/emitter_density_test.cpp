// Points and rays of emitters against the densities they claim.
#include "core/statistics.h"
#include "scene/emitters/emitters.h"
#include "support/chance.h"
#include "support/chi_squared.h"
#include "support/test_scenes.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

using test::direction_histogram;

const double kThreshold = test::sidak_threshold(11);

/// A small picture with some pixels black, some bright.
EnvironmentImage picture(SphereLayout layout, int width, int height) {
    EnvironmentImage image{width, height, {}, layout};
    for (int i = 0; i < width * height; ++i)
        image.radiance.emplace_back(i % 5 == 0 ? Vec3(0.0f)
                                               : Vec3(0.2f + static_cast<float>(i % 7), 1, i == 9 ? 40.0f : 0.5f));
    return image;
}

/// A turn about two axes, and a mirror image.
Imath::M33d turned() {
    Imath::M44d m;
    m.setEulerAngles(Imath::V3d(0.4, 1.1, -0.3));
    return {-m[0][0], -m[0][1], -m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1], m[2][2]};
}

std::vector<std::unique_ptr<Emitter>> environments() {
    std::vector<std::unique_ptr<Emitter>> list;
    list.push_back(make_image_environment(picture(SphereLayout::lat_long, 8, 5), Rgb(1.0, 2.0, 1.0), turned()));
    list.push_back(make_image_environment(picture(SphereLayout::octahedral, 6, 6), Rgb(1.0), turned()));
    std::vector<std::unique_ptr<Emitter>> parts;
    parts.push_back(make_constant_environment(Rgb(1.0)));
    parts.push_back(make_image_environment(picture(SphereLayout::octahedral, 4, 4), Rgb(2.0), Imath::M33d()));
    list.push_back(make_environment_sum(std::move(parts)));
    for (auto& e : list) e->enclose({{1, 2, 3}, 2});
    return list;
}

TEST(EnvironmentDensity_Directions, AreDrawnAsClaimed) {
    std::uint64_t stream = 0;
    for (const auto& e : environments()) {
        const auto sample = [&](SampleSource& source) -> std::optional<Vec3> {
            const EmitterPoint p = e->sample_point(source);
            EXPECT_EQ(p.pdf, e->point_pdf(p.point));
            return p.point.p;
        };
        const auto density = [&](const Vec3& w) { return e->point_pdf(infinite_point(w)); };
        EXPECT_GT(direction_histogram(sample, density, ++stream).p_value(), kThreshold);
    }
}

TEST(EnvironmentDensity_Pictures, AreProportionalToTheirLuminance) {
    const auto list = environments();
    Rng rng(8, StreamPurpose::test, 0);
    for (std::size_t i = 0; i < 2; ++i) {
        const Emitter& e = *list[i];
        const double flux = e.power() / (kPi * 4); // the beam has radius 2
        for (int k = 0; k < 5000; ++k) {
            const double u0 = rng.next(), u1 = rng.next();
            const SurfacePoint point = infinite_point(uniform_sphere(u0, u1));
            const double y = luminance(e.radiance(point, point.ng));
            ASSERT_NEAR(y, e.point_pdf(point) * flux, 1e-9 * flux);
        }
    }
}

TEST(SphereMap_Octahedral, GivesEqualAreasEqualSolidAngles) {
    const auto sample = [](SampleSource& source) -> std::optional<Vec3> {
        const double x = source.next(), y = source.next();
        return sphere_direction(SphereLayout::octahedral, {x, y});
    };
    EXPECT_GT(direction_histogram(
                  sample, [](const Vec3&) { return kInvPi / 4; }, 4)
                  .p_value(),
              kThreshold);
}

TEST(SphereMap_BothLayouts, ComeBack) {
    Rng rng(9, StreamPurpose::test, 0);
    for (const auto layout : {SphereLayout::octahedral, SphereLayout::lat_long}) {
        for (int i = 0; i < 2000; ++i) {
            const double x = rng.next(), y = rng.next();
            const Vec2d back = sphere_place(layout, sphere_direction(layout, {x, y}));
            const double near_edge = std::min({x, 1 - x, y, 1 - y});
            if (near_edge < 1e-3) continue; // where the picture is cut, either side is right
            EXPECT_NEAR(back.x, x, 2e-4);
            EXPECT_NEAR(back.y, y, 2e-4);
        }
    }
}

TEST(SphereMap_Landmarks, AreWhereTheDocumentationSays) {
    const auto near = [](const Vec3& a, const Vec3& b) { return (a - b).length() < 1e-6f; };
    EXPECT_TRUE(near(sphere_direction(SphereLayout::lat_long, {0.5, 0.5}), {0, 0, -1}));
    EXPECT_TRUE(near(sphere_direction(SphereLayout::lat_long, {0.75, 0.5}), {1, 0, 0}));
    EXPECT_TRUE(near(sphere_direction(SphereLayout::lat_long, {0.1, 0}), {0, 1, 0}));
    EXPECT_TRUE(near(sphere_direction(SphereLayout::octahedral, {0.5, 0.5}), {0, 0, 1}));
    EXPECT_TRUE(near(sphere_direction(SphereLayout::octahedral, {0, 1}), {0, 0, -1}));
    EXPECT_TRUE(near(sphere_direction(SphereLayout::octahedral, {1, 0.5}), {1, 0, 0}));
    EXPECT_TRUE(near(sphere_direction(SphereLayout::octahedral, {0.5, 1}), {0, 1, 0}));
}

void expect_rays_as_claimed(const Emitter& e, const SurfacePoint& point, std::uint64_t stream) {
    const auto sample = [&](SampleSource& source) -> std::optional<Vec3> { return e.sample_ray(point, source).w; };
    const auto density = [&](const Vec3& w) { return e.ray_pdf(point, w); };
    EXPECT_GT(direction_histogram(sample, density, stream).p_value(), kThreshold);
}

TEST(EmitterDensity_Rays, LeaveASpotAsClaimed) {
    std::uint64_t stream = 5;
    for (const SpotFade fade : {SpotFade::smooth, SpotFade::squared}) {
        const auto e = make_spot_emitter(
            {.axis = Vec3(1, 2, -1).normalized(), .full_degrees = 25, .edge_degrees = 75, .fade = fade});
        Rng rng(1, StreamPurpose::test, 0);
        expect_rays_as_claimed(*e, e->sample_point(rng).point, stream);
        stream += 50;
    }
}

/// A luminaire by longitude and latitude, one in an octahedral picture, and a projector.
std::vector<std::unique_ptr<Emitter>> pictures_of_intensity() {
    const PictureFrame frame{{1, 2, 3}, turned()};
    std::vector<std::unique_ptr<Emitter>> list;
    list.push_back(make_goniometric_emitter(picture(SphereLayout::lat_long, 8, 5), frame, Rgb(1.0, 2.0, 1.0)));
    list.push_back(make_goniometric_emitter(picture(SphereLayout::octahedral, 6, 6), frame, Rgb(1.0)));
    list.push_back(make_projection_emitter(picture(SphereLayout::lat_long, 5, 4), 70, frame, Rgb(3.0)));
    return list;
}

TEST(EmitterDensity_Rays, LeavePicturesOfIntensityAsClaimed) {
    std::uint64_t stream = 20;
    for (const auto& e : pictures_of_intensity()) {
        Rng rng(1, StreamPurpose::test, stream);
        expect_rays_as_claimed(*e, e->sample_point(rng).point, ++stream);
    }
}

TEST(EmitterDensity_Power, OfPicturesOfIntensityIsTheirIntegral) {
    for (const auto& e : pictures_of_intensity()) {
        Rng rng(3, StreamPurpose::test, 0);
        const SurfacePoint point = e->sample_point(rng).point;
        RunningStats uniform, drawn;
        for (int i = 0; i < 200'000; ++i) {
            const double u0 = rng.next(), u1 = rng.next();
            uniform.add(4 * kPi * luminance(e->radiance(point, uniform_sphere(u0, u1))));
            const EmitterRay ray = e->sample_ray(point, rng);
            // Rounded into a black pixel beside its own it has no density, and carries nothing.
            drawn.add(ray.pdf > 0 ? luminance(e->radiance(point, ray.w)) / ray.pdf : 0.0);
        }
        EXPECT_TRUE(test::has_mean(uniform, e->power(), 6, 0.002 * e->power()));
        EXPECT_TRUE(test::has_mean(drawn, e->power(), 6, 0.002 * e->power()));
    }
}

TEST(EmitterDensity_Rays, LeaveAnAreaAsClaimed) {
    for (const bool two_sided : {false, true}) {
        test::SceneMaker m;
        m.rectangle({0, 0, 0}, {1, 0.5f, 0}, {0, 1, 0.5f}, make_diffuse(Rgb(0.0)), Rgb(1.0), two_sided);
        const auto scene = m.build();
        Rng rng(1, StreamPurpose::test, 0);
        expect_rays_as_claimed(scene->emitter(0), scene->emitter(0).sample_point(rng).point, 6);
    }
}

TEST(EmitterDensity_Beam, IsUniformOverItsCrossSectionAndStartsOutside) {
    const auto e = make_distant_emitter(Vec3(1, 2, -1).normalized(), Rgb(1.0));
    const BoundingSphere scene{{1, 2, 3}, 2};
    e->enclose(scene);
    Rng rng(2, StreamPurpose::test, 0);
    const SurfacePoint point = e->sample_point(rng).point;
    const Frame frame(point.ng);
    constexpr int n = 20'000;
    test::Histogram h{std::vector<double>(32, 0), std::vector<double>(32, n / 32.0)};
    for (int i = 0; i < n; ++i) {
        const EmitterRay ray = e->sample_ray(point, rng);
        const Vec3 d = frame.to_local(ray.origin.p - scene.center);
        const double r2 = (d.x * d.x + d.y * d.y) / 4, phi = std::atan2(d.y, d.x) / (2 * kPi) + 0.5;
        ASSERT_LT(r2, 1.0001);
        ASSERT_LE(d.z, -1.999f);
        h.observed[static_cast<std::size_t>(std::min(r2, 0.9999) * 4) * 8 + static_cast<std::size_t>(phi * 7.9999)] +=
            1;
        ASSERT_NEAR(ray.pdf * kPi * 4, 1, 1e-9);
    }
    EXPECT_GT(h.p_value(), kThreshold);
}

} // namespace
} // namespace keyhole
