// Textures by place: projections in place of texture coordinates, checkerboards and noise in space, mixes by direction.
#include "scene/geometry.h"
#include "scene/load/load.h"
#include "scene/texture.h"
#include "support/pbrt_scenes.h"
#include "support/scratch_directory.h"

#include <gtest/gtest.h>

namespace keyhole {
namespace {

SurfacePoint at(const Vec3& p, const Vec3& normal = {0, 0, 1}) {
    SurfacePoint s;
    s.p = p;
    s.ng = s.ns = normal;
    s.shape = s.primitive = 0;
    return s;
}

/// What a diffuse material reflects.
Rgb reflectance(const Shape& shape, const SurfacePoint& point) {
    return shape.material->bsdf(point).eval(point.ns, point.ns) * kPi;
}

/// The red of a texture of our format.
double yaml_value(const std::string& texture, const SurfacePoint& point) {
    const ScratchDirectory directory;
    const auto scene = load_scene(directory.write(
        "s.yaml", "camera: {from: [0, 0, 4], to: [0, 0, 0]}\nshapes: [{type: rectangle, material: {type: diffuse, "
                  "reflectance: " +
                      texture + "}}]\n"));
    return reflectance(scene.description.shapes[0], point).x;
}

double pbrt_value(const std::string& before, const std::string& texture, const SurfacePoint& point) {
    const PbrtScene s(before + " Texture \"t\" \"spectrum\" " + texture +
                      " Material \"diffuse\" \"texture reflectance\" \"t\" " + kPbrtTriangle);
    return reflectance(s.shape(), point).x;
}

TEST(TextureMapping_Spherical, IsThatOfSpheres) {
    const Sphere sphere{Vec3(1, 2, 3), 2.5f};
    TextureMapping mapping;
    mapping.projection = Projection::spherical;
    mapping.from_world.setTranslation(Imath::V3d(-1, -2, -3));
    for (const Vec3& w : {Vec3(1, 2, 0.5f), Vec3(-1, 0.3f, -2), Vec3(0.2f, -1, 0.1f), Vec3(-2, -3, 1)}) {
        const SurfacePoint point = sphere_point(sphere, w.normalized());
        const Imath::V2d uv = mapping(point);
        EXPECT_NEAR(uv.x, point.uv.x, 1e-6);
        EXPECT_NEAR(uv.y, point.uv.y, 1e-6);
    }
}

TEST(TextureMapping_Planar, IsThePlaceInTheSpaceOfTheTexture) {
    // Squares of 2 m that are turned into the plane of x and z: u along x, v along -z.
    const std::string tiles = "{type: checkerboard, a: 0.2, b: 0.7, mapping: planar, "
                              "transform: [{scale: 2}, {rotate: [-90, 1, 0, 0]}]}";
    EXPECT_NEAR(yaml_value(tiles, at({1, 5, -1})), 0.2, 1e-6);
    EXPECT_NEAR(yaml_value(tiles, at({3, -4, -1})), 0.7, 1e-6);
    EXPECT_NEAR(yaml_value(tiles, at({3, 0, -3})), 0.2, 1e-6);
    EXPECT_NEAR(yaml_value(tiles, at({1, 0, 1})), 0.7, 1e-6);
    const std::string checks = "\"checkerboard\" \"rgb tex1\" [ 0.2 0.2 0.2 ] \"rgb tex2\" [ 0.7 0.7 0.7 ] ";
    const std::string planar = checks + "\"string mapping\" \"planar\" \"vector3 v1\" [ 0 0 2 ] \"vector3 v2\" "
                                        "[ 1 0 0 ] \"float udelta\" 0.5 ";
    // u = 2 z + 0.5, v = x, one unit to the right of the origin.
    EXPECT_NEAR(pbrt_value("Translate 1 0 0", planar, at({1.5f, 9, 0.2f})), 0.2, 1e-6);
    EXPECT_NEAR(pbrt_value("Translate 1 0 0", planar, at({1.5f, 9, 0.3f})), 0.7, 1e-6);
    EXPECT_NEAR(pbrt_value("Translate 1 0 0", planar, at({0.5f, 9, 0.2f})), 0.7, 1e-6);
}

TEST(TextureMapping_Cylindrical, IsLongitudeAndHeight) {
    TextureMapping mapping;
    mapping.projection = Projection::cylindrical;
    const auto expect = [&](const Vec3& p, double u, double v) {
        const Imath::V2d uv = mapping(at(p));
        EXPECT_NEAR(uv.x, u, 1e-6);
        EXPECT_NEAR(uv.y, v, 1e-6);
    };
    expect({2, 0, 3}, 0.5, 3);
    expect({0, 5, -1}, 0.75, -1);
    expect({0, -5, 0}, 0.25, 0);
}

TEST(TextureMapping_OfPbrt, TakesTheAngleFromThePoleFirst) {
    // Stripes along the first coordinate: the lower half of a sphere about the origin is another colour.
    const std::string checks = "\"checkerboard\" \"rgb tex1\" [ 0.2 0.2 0.2 ] \"rgb tex2\" [ 0.7 0.7 0.7 ] ";
    const std::string spherical = checks + "\"string mapping\" \"spherical\" ";
    // theta / pi and phi / (2 pi) are below 1 everywhere.
    EXPECT_NEAR(pbrt_value("", spherical, at({1, 1, -1})), 0.2, 1e-6);
    TextureMapping mapping{{1, -1, 0, 0, 0, 1}, Projection::spherical};
    const Imath::V2d uv = mapping(at({0, 1, 0}));
    EXPECT_NEAR(uv.x, 0.5, 1e-9);
    EXPECT_NEAR(uv.y, 0.25, 1e-9);
}

TEST(SolidCheckerboard, HasCubes) {
    const std::string cubes = "{type: checkerboard, a: 0.2, b: 0.7, dimension: 3, transform: {scale: 2}}";
    for (int i = 0; i < 8; ++i) {
        const Vec3 p(i % 2 * 2 + 1.0f, i / 2 % 2 * 2 + 1.0f, i / 4 * 2 - 1.0f);
        const bool odd = (i % 2 + i / 2 % 2 + i / 4) % 2 == 1;
        EXPECT_NEAR(yaml_value(cubes, at(p)), odd ? 0.2 : 0.7, 1e-6) << i; // z = -1 is one cube below the origin
    }
    EXPECT_NEAR(pbrt_value("Scale 2 2 2", "\"checkerboard\" \"integer dimension\" 3 \"rgb tex1\" [ 0.2 0.2 0.2 ] ",
                           at({1, 1, 1})),
                0.2, 1e-6);
}

TEST(DirectionMix, GoesByTheCosineOfTheNormal) {
    const std::string mix = "{type: direction_mix, a: 0.8, b: 0.2, direction: [0, 3, 0]}";
    EXPECT_NEAR(yaml_value(mix, at({0, 0, 0}, {0, 1, 0})), 0.8, 1e-6);
    EXPECT_NEAR(yaml_value(mix, at({0, 0, 0}, {0, -1, 0})), 0.8, 1e-6);
    EXPECT_NEAR(yaml_value(mix, at({0, 0, 0}, {1, 0, 0})), 0.2, 1e-6);
    EXPECT_NEAR(yaml_value(mix, at({0, 0, 0}, {0.8f, 0.6f, 0})), 0.2 + 0.6 * 0.6, 1e-6);
    const std::string pbrt = "\"directionmix\" \"rgb tex1\" [ 0.8 0.8 0.8 ] \"rgb tex2\" [ 0.2 0.2 0.2 ] ";
    EXPECT_NEAR(pbrt_value("Rotate 90 1 0 0", pbrt, at({0, 0, 0}, {0, 0, 1})), 0.8, 1e-6)
        << "the direction turns along";
    EXPECT_NEAR(pbrt_value("Rotate 90 1 0 0", pbrt, at({0, 0, 0}, {0, 1, 0})), 0.2, 1e-6);
}

TEST(Noise, BeyondAllNumbersStaysAColour) {
    const std::string wild = "{type: marble, octaves: 64, roughness: 1e12, variation: 1e12, scale: 1e12}";
    EXPECT_GE(yaml_value(wild, at({3.14f, 42.3f, 7.6f})), 0);
}

TEST(Noise, IsThatOfTheFormula) {
    // Half the noise and a half, so that it is a reflectance. What is expected was found by a program of its own.
    const auto sum = [](const std::string& texture, const Vec3& p) {
        return 2 * yaml_value("{type: mix, a: 1, b: {type: " + texture + "}, amount: 0.5}", at(p)) - 1;
    };
    EXPECT_NEAR(sum("fbm, octaves: 1", {3, 42, 7}), 0, 1e-6);
    EXPECT_NEAR(sum("fbm, octaves: 1", {-3, 0, 12}), 0, 1e-6);
    EXPECT_NEAR(sum("fbm, octaves: 1", {3.14f, 42.3f, 7.6f}), 0.414983, 1e-4);
    EXPECT_NEAR(sum("fbm, octaves: 1", {-2.7f, 5.1f, -9.4f}), 0.251444, 1e-4);
    EXPECT_NEAR(sum("fbm, octaves: 3", {3.14f, 42.3f, 7.6f}), 0.355623, 1e-4);
    EXPECT_NEAR(sum("fbm, octaves: 3", {0.5f, 0.25f, 0.125f}), -0.261698, 1e-4);
    EXPECT_NEAR(sum("wrinkled, octaves: 3", {3.14f, 42.3f, 7.6f}), 0.474343, 1e-4);
    EXPECT_NEAR(sum("fbm, octaves: 1, transform: {scale: 2}", {6.28f, 84.6f, 15.2f}), 0.414983, 1e-4);
}

TEST(Noise, MakesMarbleOfThePbrtsColours) {
    const double marble = yaml_value("{type: marble, variation: 0}", at({0, 0, 0}));
    // Half way along the spline its fourth curve begins, at its first colour.
    EXPECT_NEAR(marble, 1.5 * 0.5, 1e-6);
    const double crest = yaml_value("{type: marble, variation: 0}", at({0, static_cast<float>(kPi / 2), 0}));
    EXPECT_NEAR(crest, 1.5 * 0.58, 1e-6);
}

} // namespace
} // namespace keyhole
