// What programs for modelling write into scenes: normal maps, turned textures, suns with a disc, pictures on lamps,
// shifted and cropped cameras, exposures.
#include "core/error.h"
#include "film/tonemap.h"
#include "scene/emitters/emitters.h"
#include "scene/load/load.h"
#include "scene/scene.h"
#include "support/scratch_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace keyhole {
namespace {

using testing::HasSubstr;

class ExportedScene : public testing::Test {
  protected:
    /// A scene of a rectangle at z = 0, [-1,1]^2, 4 m before a camera that looks down -z.
    LoadedScene load(const std::string& material, const std::string& more = "", const std::string& camera = "",
                     const std::string& shape = "") {
        return load_scene(directory_.write("s.yaml", "camera: {from: [0, 0, 4], to: [0, 0, 0]" + camera +
                                                         "}\nshapes: [{type: rectangle, material: {" + material + "}" +
                                                         shape + "}]\n" + more),
                          {});
    }
    std::string error(const std::string& material, const std::string& more = "", const std::string& camera = "",
                      const std::string& shape = "") {
        try {
            load(material, more, camera, shape);
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    }
    void write_dot(const std::string& name, std::vector<unsigned char> rgb) {
        directory_.write(name, "P6\n1 1\n255\n" + std::string(rgb.begin(), rgb.end()));
    }
    /// Two grey pixels, left and right.
    void write_pair(const std::string& name, float left, float right) {
        std::string bytes = "Pf\n2 1\n-1.0\n";
        for (const float x : {left, right}) bytes.append(reinterpret_cast<const char*>(&x), sizeof x);
        directory_.write(name, bytes);
    }

  private:
    ScratchDirectory directory_;
};

SurfacePoint front(float u, float v) {
    SurfacePoint p;
    p.ng = p.ns = Vec3(0, 0, 1);
    p.tangent = Vec3(1, 0, 0);
    p.uv = {u, v};
    return p;
}

TEST_F(ExportedScene, NormalMapTurnsTheShadingNormal) {
    write_dot("n.ppm", {204, 51, 230}); // 0.6, -0.6, 0.8 and a bit
    const auto scene = load("type: diffuse, normal_map: {type: image, file: n.ppm}").description;
    const Material& m = *scene.shapes[0].material;
    const Vec3 n = m.bsdf(front(0.5f, 0.5f)).shading_normal();
    EXPECT_NEAR(n.x / n.z, 0.6 / (2 * 230.0 / 255 - 1), 1e-4) << "integers are linear";
    EXPECT_NEAR(n.y / n.z, -0.6 / (2 * 230.0 / 255 - 1), 1e-4);
    SurfacePoint mirrored = front(0.5f, 0.5f);
    mirrored.dpdv = {0, -1};
    EXPECT_GT(m.bsdf(mirrored).shading_normal().y, 0.3f) << "towards increasing v";
    SurfacePoint bare = front(0.5f, 0.5f);
    bare.tangent = Vec3(0, 0, 0);
    EXPECT_EQ(m.bsdf(bare).shading_normal(), Vec3(0, 0, 1)) << "no parametrisation";
    EXPECT_THAT(error("type: diffuse, normal_map: 2"), HasSubstr("s.yaml:2:"));
    EXPECT_THAT(error("type: diffuse, normal_map: {type: image, file: no.png}"), HasSubstr("no.png"));
}

TEST_F(ExportedScene, TexturesAreTurnedBetweenRepeatAndShift) {
    const UvMapping turn{.su = 2, .sv = 3, .du = 0.5, .dv = 0.25, .cosine = 0, .sine = 1};
    EXPECT_EQ(turn({1, 0}), Imath::V2d(0.5, 2.25));
    EXPECT_EQ(turn({0, 1}), Imath::V2d(-2.5, 0.25));
    write_pair("p.pfm", 0.25f, 0.75f);
    const auto value = [&](const std::string& options, float u, float v) {
        const auto scene =
            load("type: diffuse, reflectance: {type: image, file: p.pfm, filter: nearest" + options + "}").description;
        const Vec3 up(0, 0, 1);
        return scene.shapes[0].material->bsdf(front(u, v)).eval(up, up).x * kPi;
    };
    EXPECT_NEAR(value("", 0.2f, 0.7f), 0.25, 1e-6);
    EXPECT_NEAR(value(", rotate: -90", 0.2f, 0.7f), 0.75, 1e-6) << "v is u now";
    EXPECT_NEAR(value(", rotate: -90", 0.7f, 0.2f), 0.25, 1e-6);
    EXPECT_THAT(error("type: diffuse, reflectance: {type: checkerboard, a: 0, b: 1, rotate: x}"),
                HasSubstr("s.yaml:2:"));
}

TEST_F(ExportedScene, SunsWithADiscAreEnvironments) {
    auto scene =
        load("type: diffuse", "emitters: [{type: distant, direction: [1, 2, -3], irradiance: 5, angle: 0.53}]\n");
    ASSERT_EQ(scene.description.emitters.size(), 1u);
    const Emitter& sun = *scene.description.emitters[0];
    EXPECT_TRUE(is_environment(sun));
    const Vec3 axis = Vec3(-1, -2, 3).normalized();
    Rng rng(1, StreamPurpose::test, 0);
    double sum = 0;
    constexpr int n = 1000;
    for (int i = 0; i < n; ++i) {
        const EmitterPoint at = sun.sample_point(rng);
        EXPECT_LE(std::asin(static_cast<double>(at.point.p.cross(axis).length())), 0.2651 * kPi / 180);
        EXPECT_NEAR(sun.point_pdf(at.point), at.pdf, 1e-9 * at.pdf);
        sum += sun.radiance(at.point, at.point.ng).y * at.point.p.dot(axis) / at.pdf / n;
    }
    EXPECT_NEAR(sum, 5, 1e-4) << "irradiance on a plane across it";
    const SurfacePoint beside = infinite_point((axis + Frame(axis).s * 0.01f).normalized());
    EXPECT_EQ(sun.point_pdf(beside), 0);
    EXPECT_TRUE(is_black(sun.radiance(beside, beside.ng)));
    EXPECT_TRUE(is_black(sun.radiance(infinite_point(-axis), axis)));
    EXPECT_TRUE(make_distant_emitter({0, 0, 1}, Rgb(1.0), 0)->is_delta());
    EXPECT_THAT(error("type: diffuse", "emitters: [{type: distant, direction: [0, 0, 1], irradiance: 1, angle: 91}]\n"),
                HasSubstr("s.yaml:3:"));
}

TEST_F(ExportedScene, LampsShineAsTheirPictures) {
    write_pair("p.pfm", 1, 3);
    auto loaded =
        load("type: black", "", "", ", emission: {radiance: 2, texture: {type: image, file: p.pfm, filter: nearest}}");
    const Scene scene(std::move(loaded.description));
    const Emitter& lamp = scene.emitter(0);
    EXPECT_NEAR(lamp.power(), 2 * 2.0 * 4 * kPi, 0.02 * lamp.power()) << "4 m^2 of mean radiance 4";
    Rng rng(1, StreamPurpose::test, 0);
    for (int i = 0; i < 100; ++i) {
        const SurfacePoint drawn = lamp.sample_point(rng).point;
        if (std::abs(drawn.p.x) < 1e-3f) continue; // on the edge between the pixels
        EXPECT_NEAR(lamp.radiance(drawn, {0, 0, 1}).x, drawn.p.x < 0 ? 2 : 6, 1e-5) << drawn.p;
        const auto seen = scene.trace(scene.camera().eye(0, 0), (drawn.p - Vec3(0, 0, 4)).normalized());
        ASSERT_TRUE(seen && seen->is_emitter());
        EXPECT_NEAR(lamp.radiance(*seen, {0, 0, 1}).x, lamp.radiance(drawn, {0, 0, 1}).x, 1e-3) << "hit as drawn";
    }
    EXPECT_THAT(error("type: black", "", "", ", emission: {power: 2, texture: 1}"),
                HasSubstr("found 'power' beside 'texture', expected 'radiance'"));
    EXPECT_THAT(error("type: black", "", "", ", emission: {radiance: 2, texture: -1}"), HasSubstr("s.yaml:2:"));
}

/// Just above the middle of the rectangle.
SurfacePoint at_origin() {
    SurfacePoint s;
    s.site = Site::point;
    s.p = {0, 0, 0.01f};
    return s;
}

/// The pixel that a place is seen at; none outside the picture.
std::optional<Vec2> pixel_of(const SceneDescription& scene, const Vec3& p) {
    const Camera camera(scene.camera, scene.window);
    const SurfacePoint eye = camera.eye(0, 0);
    const auto at = camera.image_point(eye, (p - eye.p).normalized());
    if (!at) return std::nullopt;
    EXPECT_LT((camera.ray_direction(eye, *at) - (p - eye.p).normalized()).length(), 1e-5) << "there and back";
    return scene.window.to_pixel(*at);
}

TEST_F(ExportedScene, CamerasShiftTheirPicture) {
    const std::string film = "film: {resolution: [80, 40]}\n";
    // The film's shorter side sees 4 m at the rectangle.
    const std::string wide = ", fov: " + std::to_string(2 * std::atan(0.5) * 180 / kPi);
    const auto plain = pixel_of(load("type: diffuse", film, wide).description, {0, 0, 0});
    ASSERT_TRUE(plain);
    EXPECT_LT((*plain - Vec2(40, 20)).length(), 1e-3f);
    const auto shifted = load("type: diffuse", film, wide + ", shift: [0.5, -0.25]").description;
    const auto moved = pixel_of(shifted, {0, 0, 0});
    ASSERT_TRUE(moved);
    EXPECT_LT((*moved - Vec2(20, 10)).length(), 1e-3f) << "the picture looks right and down";
    EXPECT_FALSE(pixel_of(shifted, {-2.1f, 0, 0}));
    EXPECT_TRUE(pixel_of(shifted, {-1.9f, 0, 0}));
    EXPECT_THAT(error("type: diffuse", "", ", shift: 1"), HasSubstr("s.yaml:1:"));
    EXPECT_THAT(error("type: diffuse", "", ", shift: [1, 101]"), HasSubstr("expected a shift"));
}

TEST_F(ExportedScene, CamerasMaySeeAlongParallels) {
    const std::string film = "film: {resolution: [80, 40]}\n", parallel = ", orthographic: 4";
    const auto scene = load("type: diffuse", film, parallel).description;
    for (const float z : {3.5f, 0.0f, -2.0f}) { // 10 pixels a metre at any depth
        const auto at = pixel_of(scene, {1, -0.5f, z});
        ASSERT_TRUE(at);
        EXPECT_LT((*at - Vec2(50, 25)).length(), 0.02f) << z;
    }
    EXPECT_FALSE(pixel_of(scene, {0, 2.05f, 0}));
    const auto moved = pixel_of(load("type: diffuse", film, parallel + ", shift: [0.5, 0]").description, {1, -0.5f, 0});
    ASSERT_TRUE(moved);
    EXPECT_LT((*moved - Vec2(30, 25)).length(), 0.02f);
    const auto part =
        pixel_of(load("type: diffuse", "film: {resolution: [80, 40], crop: [40, 10, 70, 35]}\n", parallel).description,
                 {1, -0.5f, 0});
    ASSERT_TRUE(part);
    EXPECT_LT((*part - Vec2(10, 15)).length(), 0.02f);
}

/// At the distance d a point is seen through a disc of |1 - d / f| times the radius of the lens.
TEST_F(ExportedScene, ParallelSightMayHaveALens) {
    const Scene scene(load("type: diffuse", "", ", orthographic: 4, lens_radius: 0.1, focus_distance: 2").description);
    for (const float d : {0.5f, 2.0f, 3.0f}) {
        float radius = 0, least = 1e9f;
        for (const double u : {0.0, 0.25, 0.5, 0.75}) {
            const SurfacePoint eye = scene.camera().eye(1 - 1e-9, u);
            const Vec3 w = scene.camera().ray_direction(eye, {0.5f, 0.5f});
            const Vec3 start = eye.p + w * eye.offset;
            EXPECT_NEAR(start.z, 4, 1e-2f) << "nothing is seen before the plane";
            const Vec3 at = start + w * ((4 - d - start.z) / w.z);
            radius = std::max(radius, std::hypot(at.x, at.y));
            least = std::min(least, std::hypot(at.x, at.y));
        }
        EXPECT_NEAR(radius, 0.1f * std::abs(1 - d / 2), 2e-3f) << d;
        EXPECT_NEAR(least, radius, 4e-3f) << d;
    }
}

TEST_F(ExportedScene, ParallelSightBeginsAtItsPlane) {
    // A wall behind the plane of the camera, at z = 4, and one before it.
    for (const float z : {5.0f, 3.0f}) {
        Scene scene(load("type: diffuse", "", ", orthographic: 4",
                         "}, {type: rectangle, material: {type: black}, transform: {translate: [0, 0, " +
                             std::to_string(z) + "]}")
                        .description);
        const SurfacePoint eye = scene.camera().eye(0, 0);
        const auto seen = scene.trace(eye, scene.camera().ray_direction(eye, {0.5f, 0.5f}));
        ASSERT_TRUE(seen);
        EXPECT_NEAR(seen->p.z, z < 4 ? z : 0, 1e-3f);
        EXPECT_EQ(scene.visible(at_origin(), eye), z > 4);
        EXPECT_EQ(scene.visible(eye, at_origin()), z > 4);
        SurfacePoint there = at_origin();
        there.p.z = z;
        EXPECT_EQ(scene.visible(there, eye), z < 4) << "no light from before the plane to the eye";
        EXPECT_EQ(scene.visible(eye, there), z < 4);
    }
}

TEST_F(ExportedScene, CropsArePartsOfTheWholePicture) {
    const std::string film = "film: {resolution: [80, 40]", camera = ", fov: 50, shift: [0.2, 0.1]";
    const auto whole = load("type: diffuse", film + "}\n", camera).description,
               part = load("type: diffuse", film + ", crop: [10, 5, 70, 31]}\n", camera).description;
    EXPECT_EQ(part.window.width, 60);
    EXPECT_EQ(part.window.height, 26);
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0.9f, 0.4f, 0), Vec3(-0.5f, -0.3f, 1)}) {
        const auto all = pixel_of(whole, p), cut = pixel_of(part, p);
        ASSERT_TRUE(all && cut);
        EXPECT_LT((*all - Vec2(10, 5) - *cut).length(), 1e-3f) << p;
    }
    for (const char* crop : {"[0, 0, 81, 40]", "[5, 0, 5, 40]", "[0, 30, 10, 20]"})
        EXPECT_THAT(error("type: diffuse", film + ", crop: " + crop + "}\n"),
                    HasSubstr("expected pixels of a film of 80 x 40"))
            << crop;
    EXPECT_THAT(error("type: diffuse", film + ", crop: [1, 2]}\n"), HasSubstr("expected [left, top, right, bottom]"));
}

TEST_F(ExportedScene, ExposureIsASetting) {
    EXPECT_FALSE(load("type: diffuse").settings.exposure.value);
    EXPECT_EQ(load("type: diffuse", "render: {exposure: -1.5}\n").settings.exposure.value, -1.5);
    EXPECT_THAT(error("type: diffuse", "render: {exposure: bright}\n"),
                HasSubstr("expected a number from -100 to 100, or auto"));
}

TEST(Exposure_Picture, ShowsRadianceTimesAPowerOfTwo) {
    Image image(2, 1, 3);
    image.data = {0.25f, 0.05f, 0.0f, 100.0f, NAN, 1.0f};
    const auto bytes = expose_by(image, 1);
    EXPECT_EQ(bytes[0], std::lround(255 * srgb_encode(0.5f)));
    EXPECT_EQ(bytes[1], std::lround(255 * srgb_encode(0.1f)));
    EXPECT_EQ(bytes[2], 0);
    image.data[3] = 1e9f;
    EXPECT_EQ(expose_by(image, 1)[0], bytes[0]) << "whatever else is in the picture";
    EXPECT_EQ(expose_by(image, 3)[0], 255);
}

} // namespace
} // namespace keyhole
