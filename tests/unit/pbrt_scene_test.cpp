// What directives of pbrt's format mean: transforms, view, shapes, lights, instances.
#include "core/error.h"
#include "scene/geometry.h"
#include "scene/load/load.h"
#include "support/pbrt_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace keyhole {
namespace {

using testing::HasSubstr;

const std::string kTriangle = kPbrtTriangle;

void expect_near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
    EXPECT_LT((a - b).length(), tolerance) << a << " is not " << b;
}

Vec3 normal(const TriangleMesh& mesh, std::size_t i) {
    const auto& t = mesh.triangles.at(i);
    const auto& p = mesh.positions;
    return (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).normalized();
}

/// Where the transform takes (1, 2, 3).
Vec3 moved(const std::string& transform) {
    return PbrtScene(transform + " Shape \"trianglemesh\" \"point3 P\" [ 1 2 3  5 0 0  0 5 0 ]").mesh().positions[0];
}

TEST(PbrtTransforms, ActInTheirOrder) {
    expect_near(moved("Translate 10 0 0 Scale 2 2 2"), {12, 4, 6}); // the last one acts first
    expect_near(moved("Scale 2 2 2 Translate 10 0 0"), {22, 4, 6});
    expect_near(moved("Rotate 90 0 0 1"), {-2, 1, 3});
    expect_near(moved("Translate 9 9 9 Identity"), {1, 2, 3});
    expect_near(moved("Scale 3 3 3 Transform [1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1]"), {5, 7, 9});
    expect_near(moved("Scale 2 2 2 ConcatTransform [1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1]"), {10, 14, 18});
    expect_near(moved("Transform [0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1]"), {-2, 1, 3});
    expect_near(moved("TransformBegin Scale 2 2 2 TransformEnd"), {1, 2, 3});
    expect_near(moved("Scale 2 2 2 CoordinateSystem \"big\" Identity CoordSysTransform \"big\""), {2, 4, 6});
    expect_near(moved("ActiveTransform EndTime Translate 5 5 5 ActiveTransform All"), {1, 2, 3});
    EXPECT_THAT(pbrt_error("Scale 1 0 1 " + kTriangle), HasSubstr("flattens the shape"));
    EXPECT_THAT(pbrt_error("Rotate 90 0 0 0 " + kTriangle), HasSubstr("found the axis 0 0 0"));
    EXPECT_THAT(pbrt_error("CoordSysTransform \"no\" " + kTriangle), HasSubstr("unknown coordinate system 'no'"));
}

TEST(PbrtCamera, LooksWhereLookAtSays) {
    const auto c = PbrtScene(kTriangle, "LookAt 1 2 3  1 2 -7  0 1 0 Camera \"perspective\" \"float fov\" 50")
                       .scene.description.camera;
    expect_near(c.origin, {1, 2, 3});
    expect_near(c.forward, {0, 0, -1});
    expect_near(c.up, {0, 1, 0});
    expect_near(c.right, {-1, 0, 0}); // pbrt's camera space is left-handed
    EXPECT_FLOAT_EQ(c.fov_degrees, 50);
}

TEST(PbrtCamera, MayBeMirroredAndScaled) {
    const auto c =
        PbrtScene(kTriangle, "Scale -1 1 1 LookAt 0 0 3  0 0 0  0 1 0 Camera \"perspective\"").scene.description.camera;
    expect_near(c.right, {1, 0, 0});
    EXPECT_FLOAT_EQ(c.fov_degrees, 90);
    const auto s =
        PbrtScene(kTriangle, "Scale 0.5 0.5 0.5 Translate 0 0 -4 Camera \"perspective\" \"float lensradius\" 0.1 "
                             "\"float focaldistance\" 3")
            .scene.description.camera;
    expect_near(s.origin, {0, 0, 4});
    EXPECT_FLOAT_EQ(s.lens_radius, 0.2f);
    EXPECT_FLOAT_EQ(s.focus_distance, 6);
    EXPECT_THAT(pbrt_error(kTriangle, "Scale 1 2 1 Camera \"perspective\""), HasSubstr("stretches the camera"));
    EXPECT_THAT(pbrt_error(kTriangle, "Camera \"spherical\""), HasSubstr("expected perspective or orthographic"));
}

TEST(PbrtCamera, ScreenWindowNarrowsTheView) {
    const auto fov = [](const std::string& window) {
        return PbrtScene(kTriangle, "Camera \"perspective\" \"float fov\" 90 \"float screenwindow\" [" + window + "]")
            .scene.description.camera.fov_degrees;
    };
    EXPECT_NEAR(fov("-0.666667 0.666667 -0.5 0.5"), std::atan(0.5) * 360 / kPi, 1e-3);
    EXPECT_THROW(fov("-1 1 -1 1"), InputError);       // oblong pixels on 8 x 6
    EXPECT_THROW(fov("1 -1 0.75 -0.75"), InputError); // empty
}

Vec2 seen_at(const PbrtScene& s, const Vec3& direction) {
    const Camera camera(s.scene.description.camera, s.scene.description.window);
    const auto at = camera.image_point(camera.eye(0, 0), direction.normalized());
    return at ? s.scene.description.window.to_pixel(*at) : Vec2(-1, -1);
}

TEST(PbrtCamera, MaySeeAlongParallels) {
    const PbrtScene s(kTriangle, "Scale 0.5 0.5 0.5 LookAt 0 0 3  0 0 0  0 1 0 Camera \"orthographic\" \"float "
                                 "screenwindow\" [ -2 2 -1.5 1.5 ]");
    const Camera camera(s.scene.description.camera, s.scene.description.window);
    const SurfacePoint eye = camera.eye(0, 0);
    for (const float z : {1.0f, 0.0f, -3.0f}) { // the window is 8 x 6 m, of 8 x 6 pixels
        const auto at = camera.image_point(eye, (Vec3(2, -1, z) - eye.p).normalized());
        ASSERT_TRUE(at);
        const Vec2 pixel = s.scene.description.window.to_pixel(*at);
        EXPECT_NEAR(pixel.x, 2, 0.01); // pbrt's camera space is left-handed
        EXPECT_NEAR(pixel.y, 4, 0.01);
    }
}

TEST(PbrtCamera, ScreenWindowShiftsTheView) {
    const PbrtScene s(kTriangle,
                      "Camera \"perspective\" \"float fov\" 90 \"float screenwindow\" [0 1.333333 -0.5 0.5]");
    // 8 x 6 pixels; the axis is in the middle of the left edge.
    const Vec2 p = seen_at(s, {0.333333f, 0.25f, 1});
    EXPECT_NEAR(p.x, 2, 1e-3);
    EXPECT_NEAR(p.y, 1.5, 1e-3);
}

TEST(PbrtCamera, CropsTheFilm) {
    for (const char* film : {"\"float cropwindow\" [ 0.25 0.875 0.5 1 ]", "\"integer pixelbounds\" [ 2 7 3 6 ]"}) {
        const std::string camera = "Camera \"perspective\" \"float fov\" 70 \"float screenwindow\" [-1 1.2 -0.8 0.85]";
        const std::string size = "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6 ";
        const PbrtScene all(kTriangle, size + camera), part(kTriangle, size + film + " " + camera);
        EXPECT_EQ(part.scene.description.window.width, 5);
        EXPECT_EQ(part.scene.description.window.height, 3);
        for (const Vec3& w : {Vec3(0.1f, 0.01f, 1), Vec3(0.3f, -0.2f, 1)}) {
            const Vec2 whole = seen_at(all, w), cut = seen_at(part, w);
            EXPECT_NEAR(whole.x - 2, cut.x, 1e-4);
            EXPECT_NEAR(whole.y - 3, cut.y, 1e-4);
        }
    }
    for (const char* film : {"\"float cropwindow\" [ 0 0 0 1 ]", "\"float cropwindow\" [ 0 2 0 1 ]",
                             "\"float cropwindow\" [ 0 1 ]", "\"integer pixelbounds\" [ -1 3 0 1 ]"})
        EXPECT_THROW(PbrtScene(kTriangle, std::string("Film \"rgb\" ") + film), InputError) << film;
}

TEST(PbrtOptions, BecomeSettings) {
    const PbrtScene s(kTriangle,
                      "Integrator \"volpath\" \"integer maxdepth\" 7 Sampler \"halton\" \"integer pixelsamples\" 33 "
                      "PixelFilter \"mitchell\" PixelFilter \"mitchell\" Accelerator \"bvh\" Option \"bool "
                      "disablepixeljitter\" true");
    EXPECT_EQ(s.scene.settings.max_depth, 7);
    EXPECT_EQ(s.scene.settings.spp, 33);
    EXPECT_EQ(s.scene.description.window.width, 8);
    EXPECT_EQ(s.scene.description.window.height, 6);
    ASSERT_EQ(s.warnings.size(), 1u);
    EXPECT_THAT(s.warnings[0], HasSubstr("PixelFilter \"mitchell\": the picture is filtered by a Gaussian"));
    EXPECT_EQ(PbrtScene(kTriangle).scene.settings.max_depth, 5) << "pbrt's default";
    EXPECT_EQ(PbrtScene(kTriangle, "Integrator \"path\" \"integer maxdepth\" 100").scene.settings.max_depth, 100);
    const PbrtScene deep(kTriangle, "Integrator \"path\" \"integer maxdepth\" 1000");
    EXPECT_LT(deep.scene.settings.max_depth, 1000);
    EXPECT_THAT(deep.warnings.at(0), HasSubstr("1000 becomes max_depth = "));
}

TEST(PbrtOptions, FiltersKeepTheirKindAndReach) {
    const auto settings = [](const std::string& filter) { return PbrtScene(kTriangle, filter).scene.settings; };
    const Settings usual = settings("");
    EXPECT_EQ(usual.filter, FilterShape::gaussian);
    EXPECT_EQ(usual.filter_radius, 1.5);
    EXPECT_EQ(usual.filter_sigma, 0.5);
    EXPECT_EQ(settings("PixelFilter \"box\"").filter_radius, 0.5);
    const Settings wide = settings("PixelFilter \"triangle\" \"float xradius\" 3 \"float yradius\" 3");
    EXPECT_EQ(wide.filter, FilterShape::triangle);
    EXPECT_EQ(wide.filter_radius, 3);
    EXPECT_EQ(settings("PixelFilter \"gaussian\" \"float alpha\" 2 \"float xwidth\" 2 \"float ywidth\" 2").filter_sigma,
              0.5)
        << "v3's names";
    EXPECT_THROW(settings("PixelFilter \"box\" \"float xradius\" 100"), InputError);
}

TEST(PbrtShapes, TrianglesFaceTheirNormals) {
    const std::string p = "\"point3 P\" [ 0 0 0  1 0 0  0 1 0 ] ";
    expect_near(normal(PbrtScene("Shape \"trianglemesh\" " + p).mesh(), 0), {0, 0, 1});
    expect_near(normal(PbrtScene("Shape \"trianglemesh\" " + p + "\"normal N\" [ 0 0 -1 0 0 -1 0 0 -1 ]").mesh(), 0),
                {0, 0, -1});
    expect_near(normal(PbrtScene("ReverseOrientation Shape \"trianglemesh\" " + p).mesh(), 0), {0, 0, -1});
    expect_near(normal(PbrtScene("Scale -1 1 1 Shape \"trianglemesh\" " + p).mesh(), 0), {0, 0, 1});
}

TEST(PbrtShapes, MeshesSayWhatIsWrong) {
    const auto in_mesh = [](const std::string& rest) { return pbrt_error("Shape \"trianglemesh\" " + rest); };
    const std::string p = "\"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 1 ] ";
    EXPECT_THAT(in_mesh(""), HasSubstr("found no 'P'"));
    EXPECT_THAT(in_mesh(p), HasSubstr("found 0 'indices'"));
    EXPECT_THAT(in_mesh(p + "\"integer indices\" [ 0 1 4 ]"),
                HasSubstr("found the vertex index 4, expected one from 0 to 3"));
    EXPECT_THAT(in_mesh(p + "\"integer indices\" [ 0 1 -1 ]"), HasSubstr("found the vertex index -1"));
    EXPECT_THAT(in_mesh(p + "\"integer indices\" [ 0 1 ]"), HasSubstr("found 2 'indices'"));
    EXPECT_THAT(in_mesh(p + "\"float indices\" [ 0 1 2 ]"), HasSubstr("expected its type to be integer"));
    EXPECT_THAT(in_mesh(p + "\"normal N\" [ 0 0 1 ] \"integer indices\" [ 0 1 2 ]"),
                HasSubstr("found 1 normals for 4 positions"));
    EXPECT_THAT(in_mesh("\"point3 P\" [ 0 0 0  1e20 0 0  0 1 0 ]"), HasSubstr("expected one within 1e12"));
    EXPECT_THAT(pbrt_error("Shape \"plymesh\""), HasSubstr("found no 'filename'"));
    EXPECT_THAT(pbrt_error("Shape \"plymesh\" \"string filename\" \"no.ply\""),
                HasSubstr("scene.pbrt:4:1: Shape \"plymesh\": "));
    EXPECT_THAT(pbrt_error("Shape \"cone\""), HasSubstr("found the shape 'cone', expected one of"));
    EXPECT_THAT(pbrt_error("Shape \"sphere\" \"float radius\" -1"), HasSubstr("found -1 as 'radius'"));
}

TEST(PbrtShapes, SpheresStayExactWhereTheyCan) {
    const PbrtScene s("Translate 1 2 3 Scale 2 2 2 Shape \"sphere\" \"float radius\" 0.5");
    expect_near(s.sphere().center, {1, 2, 3});
    EXPECT_FLOAT_EQ(s.sphere().radius, 1);
    EXPECT_TRUE(PbrtScene("ReverseOrientation Shape \"sphere\"").sphere().inward);
    EXPECT_FALSE(PbrtScene("Scale -1 1 1 Shape \"sphere\"").sphere().inward);
}

TEST(PbrtShapes, QuadricsHaveTheirAreasAndSides) {
    const auto area = [](const std::string& shape) { return surface_area(PbrtScene("Shape " + shape).shape()); };
    EXPECT_NEAR(area("\"disk\" \"float radius\" 2 \"float innerradius\" 1"), 3 * kPi, 0.003 * kPi);
    EXPECT_NEAR(area("\"disk\" \"float phimax\" 90"), kPi / 4, 1e-3);
    EXPECT_NEAR(area("\"cylinder\" \"float radius\" 0.5 \"float zmin\" 1 \"float zmax\" 3"), 2 * kPi, 1e-2);
    EXPECT_NEAR(area("\"sphere\" \"float zmin\" 0"), 2 * kPi, 1e-2);
    EXPECT_NEAR(area("\"sphere\" \"float phimax\" 180"), 2 * kPi, 1e-2);
    expect_near(normal(PbrtScene("Shape \"disk\" \"float height\" 2").mesh(), 0), {0, 0, 1});
    const PbrtScene bowl("Shape \"sphere\" \"float zmax\" 0.5");
    const auto& mesh = bowl.mesh();
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 97)
        EXPECT_GT(normal(mesh, i).dot(mesh.positions[mesh.triangles[i][0]]), 0.9f);
    EXPECT_THAT(pbrt_error("Shape \"disk\" \"float innerradius\" 1"), HasSubstr("inner radius"));
    EXPECT_THAT(pbrt_error("Shape \"sphere\" \"float zmin\" 2"), HasSubstr("expected some of the sphere"));
}

TEST(PbrtShapes, PatchesAreTrianglesWhereFlatAndFacetsWhereNot) {
    const PbrtScene flat("Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  2 0 0  0 3 0  2 3 0 ]");
    EXPECT_EQ(flat.mesh().triangles.size(), 2u);
    EXPECT_NEAR(surface_area(flat.shape()), 6, 1e-6);
    expect_near(normal(flat.mesh(), 0), {0, 0, 1});
    const PbrtScene bent(
        "Shape \"bilinearmesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0  1 1 1 ] \"integer indices\" [ 0 1 2 3 ]");
    for (const Vec3& p : bent.mesh().positions) EXPECT_NEAR(p.z, p.x * p.y, 1e-5);
}

TEST(PbrtShapes, LoopSubdivIsItsControlMesh) {
    const PbrtScene s(
        "Shape \"loopsubdiv\" \"integer levels\" 3 \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 2 ]");
    EXPECT_EQ(s.mesh().triangles.size(), 1u);
    EXPECT_THAT(s.warnings.at(0), HasSubstr("the control mesh stands for"));
}

TEST(PbrtShapes, TexturedOnesWithoutCoordinatesGetPbrts) {
    const std::string textured =
        "Texture \"t\" \"float\" \"checkerboard\" Material \"conductor\" \"texture roughness\" \"t\" ";
    const PbrtScene triangle(textured + kTriangle);
    ASSERT_EQ(triangle.mesh().uvs.size(), 3u);
    EXPECT_EQ(triangle.mesh().uvs[2], Vec2(1, 1));
    EXPECT_TRUE(PbrtScene(kTriangle).mesh().uvs.empty());
    const PbrtScene sphere(textured + "Shape \"sphere\""); // a mesh, as a Sphere forgets how it was turned
    EXPECT_NEAR(sphere.mesh().uvs[0].y, 0, 1e-6);
    EXPECT_NEAR(sphere.mesh().positions[0].z, -1, 1e-6);
}

TEST(PbrtObjects, AreCopiedWhereTheyStand) {
    const PbrtScene s("Translate 0 0 1 ObjectBegin \"o\" Translate 1 0 0 " + kTriangle +
                      "ObjectEnd\n"
                      "Identity ObjectInstance \"o\" Scale 2 2 2 ObjectInstance \"o\"");
    ASSERT_EQ(s.scene.description.shapes.size(), 2u);
    expect_near(s.mesh(0).positions[0], {1, 0, 1});
    expect_near(s.mesh(1).positions[0], {2, 0, 2});
}

TEST(PbrtObjects, DoNotShine) {
    const PbrtScene s("ObjectBegin \"o\" AreaLightSource \"diffuse\" " + kTriangle + "ObjectEnd ObjectInstance \"o\"");
    EXPECT_EQ(s.shape().emission, nullptr);
    EXPECT_THAT(s.warnings.at(0), HasSubstr("the area light is ignored"));
}

TEST(PbrtAttributes, AreDefaultsWithinTheirBlock) {
    const PbrtScene s(
        "AttributeBegin Attribute \"shape\" \"float radius\" 3 Shape \"sphere\" Shape \"sphere\" \"float radius\" 2 "
        "AttributeEnd Shape \"sphere\"");
    EXPECT_EQ(s.sphere(0).radius, 3);
    EXPECT_EQ(s.sphere(1).radius, 2);
    EXPECT_EQ(s.sphere(2).radius, 1);
}

TEST(PbrtWarnings, ComeOnceForEachKind) {
    const PbrtScene s("Shape \"sphere\" \"float raduis\" 2 Shape \"sphere\" \"float raduis\" 2");
    ASSERT_EQ(s.warnings.size(), 1u);
    EXPECT_THAT(s.warnings[0],
                HasSubstr("scene.pbrt:4:16: Shape \"sphere\": 'float raduis' means nothing here and is ignored; "
                          "did you mean 'radius'?"));
}

TEST(PbrtFiles, LoadByThemselvesAndWithinYaml) {
    const std::string file = std::string(KEYHOLE_SOURCE_DIR) + "/tests/data/pbrt/room.pbrt";
    std::vector<std::string> warnings;
    const auto scene = load(file, {"spp=3"}, &warnings);
    EXPECT_EQ(scene.description.shapes.size(), 7u);
    EXPECT_EQ(scene.settings.spp, 3);
    EXPECT_EQ(scene.settings.max_depth, 9);
    EXPECT_THAT(warnings, testing::IsEmpty());
    expect_near(scene.description.camera.origin, {0, 1, 6.8f});

    const ScratchDirectory d;
    const std::string yaml = d.write("s.yaml", "include: " + file +
                                                   "\ncamera: {fov: 33}\nrender: {spp: 5}\n"
                                                   "shapes: [{type: sphere, material: {type: diffuse}}]\n");
    const auto both = load(yaml);
    EXPECT_EQ(both.description.shapes.size(), 8u);
    EXPECT_EQ(both.settings.spp, 5);
    EXPECT_EQ(both.settings.max_depth, 9);
    EXPECT_EQ(both.description.window.width, 64);
    EXPECT_FLOAT_EQ(both.description.camera.fov_degrees, 33);
    expect_near(both.description.camera.origin, {0, 1, 6.8f});
    EXPECT_THROW(load(d.write("t.yaml", "include: no.pbrt")), InputError);
}

TEST(PbrtFiles, SharedScenesLoad) {
    const std::filesystem::path root = std::filesystem::path(KEYHOLE_SOURCE_DIR) / "../shared/scenes";
    if (!std::filesystem::exists(root)) GTEST_SKIP() << "no " << root;
    const std::vector<std::pair<std::string, std::size_t>> scenes{
        {"cornell-box/scene.pbrt", 36}, {"veach-bidir/scene.pbrt", 11544}, {"mps/box.pbrt", 14}};
    for (const auto& [name, triangles] : scenes)
        EXPECT_EQ(Scene(load((root / name).string()).description).triangle_count(), triangles) << name;
}

} // namespace
} // namespace keyhole
