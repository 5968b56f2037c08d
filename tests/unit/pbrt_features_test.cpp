// Features of pbrt's format that other tests don't name: pictures, bumps, holes in meshes, and what is warned of.
#include "core/error.h"
#include "support/pbrt_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A picture of one row in a folder of its own, by its path.
struct Row {
    explicit Row(const std::vector<float>& values) {
        std::string text = "Pf\n" + std::to_string(values.size()) + " 1\n-1.0\n";
        text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
        path = folder.write("row.pfm", text);
    }
    ScratchDirectory folder;
    std::string path;
};

SurfacePoint at(float u, float v = 0.5f) {
    SurfacePoint p;
    p.ng = p.ns = {0, 0, 1};
    p.uv = {u, v};
    return p;
}

/// Reflectance at (u, v) of a diffuse surface with an image of the row {0.2, 0.4, 0.6, 0.8}.
double reflectance(const std::string& parameters, float u) {
    const Row row({0.2f, 0.4f, 0.6f, 0.8f});
    const PbrtScene s("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + row.path + "\" " + parameters +
                      "\nMaterial \"diffuse\" \"texture reflectance\" \"t\" " + kPbrtTriangle);
    const Vec3 up(0, 0, 1);
    return s.shape().material->bsdf(at(u)).eval(up, up).x * kPi;
}

TEST(PbrtImageMap, IsReadAtItsTexels) {
    EXPECT_NEAR(reflectance("", 0.125f), 0.2, 1e-6);
    EXPECT_NEAR(reflectance("", 0.625f), 0.6, 1e-6);
    EXPECT_NEAR(reflectance("\"string filter\" \"point\"", 0.51f), 0.6, 1e-6);
    EXPECT_NEAR(reflectance("", 0.5f), 0.5, 1e-6) << "bilinear";
}

TEST(PbrtImageMap, WrapsAsItSays) {
    EXPECT_NEAR(reflectance("", 1.125f), 0.2, 1e-6) << "repeat is the default";
    EXPECT_NEAR(reflectance("\"string wrap\" \"clamp\"", 1.6f), 0.8, 1e-6);
    EXPECT_NEAR(reflectance("\"string wrap\" \"black\"", 1.6f), 0, 1e-6);
}

TEST(PbrtImageMap, IsMappedScaledAndInverted) {
    EXPECT_NEAR(reflectance("\"float uscale\" 2 \"float udelta\" 0.25", 0.1875f), 0.6, 1e-6);
    EXPECT_NEAR(reflectance("\"float scale\" 0.5", 0.625f), 0.3, 1e-6);
    EXPECT_NEAR(reflectance("\"float scale\" 0.5 \"bool invert\" true", 0.625f), 0.7, 1e-6);
    EXPECT_NEAR(reflectance("\"string encoding\" \"sRGB\"", 0.625f), 0.6, 1e-6) << "floats are linear";
}

TEST(PbrtImageMap, RefusesWhatItDoesNotKnow) {
    EXPECT_THROW(reflectance("\"string wrap\" \"sideways\"", 0), InputError);
    EXPECT_THROW(reflectance("\"string encoding\" \"loud\"", 0), InputError);
}

TEST(PbrtDisplacement, TurnsShadingNormals) {
    const Row ramp({0, 1});
    const PbrtScene s("Texture \"h\" \"float\" \"imagemap\" \"string filename\" \"" + ramp.path +
                      "\"\nMaterial \"diffuse\" \"texture displacement\" \"h\" " + kPbrtTriangle);
    // The height rises by 1 over half of u, where dp/du is 1 m long.
    const Vec3 n = s.shape().material->bsdf(at(0.5f)).shading_normal();
    EXPECT_NEAR(n.x / n.z, -2, 1e-2);
    EXPECT_TRUE(s.warnings.empty());
}

/// A picture of one colour in a folder of its own.
struct Dot {
    explicit Dot(const std::vector<float>& rgb) {
        std::string text = "PF\n1 1\n-1.0\n";
        text.append(reinterpret_cast<const char*>(rgb.data()), 3 * sizeof(float));
        path = folder.write("dot.pfm", text);
    }
    ScratchDirectory folder;
    std::string path;
};

TEST(PbrtNormalMap, TurnsShadingNormals) {
    const Dot dot({0.8f, 0.5f, 0.9f});
    const PbrtScene s("Material \"diffuse\" \"string normalmap\" \"" + dot.path + "\" " + kPbrtTriangle);
    SurfacePoint p = at(0.5f);
    p.tangent = {0, 1, 0};
    const Vec3 n = s.shape().material->bsdf(p).shading_normal();
    EXPECT_NEAR(n.y / n.z, 0.6 / 0.8, 1e-5);
    EXPECT_NEAR(n.x, 0, 1e-6);
    EXPECT_FALSE(s.mesh().uvs.empty());
    EXPECT_TRUE(s.warnings.empty());
    EXPECT_THROW(PbrtScene("Material \"diffuse\" \"string normalmap\" \"no.png\" " + kPbrtTriangle), InputError);
}

TEST(PbrtAreaLights, ShineAsTheirPictures) {
    const Dot dot({0.5f, 1, 2});
    const std::string light = "AreaLightSource \"diffuse\" \"string filename\" \"" + dot.path + "\" \"float scale\" 3 ";
    const PbrtScene s(light + kPbrtTriangle);
    ASSERT_NE(s.shape().emission->picture, nullptr);
    const Rgb c = s.shape().emission->radiance * s.shape().emission->picture->value(at(0.5f));
    EXPECT_NEAR(c.x, 1.5, 1e-6);
    EXPECT_NEAR(c.z, 6, 1e-6);
    EXPECT_FALSE(s.mesh().uvs.empty());
    EXPECT_THROW(PbrtScene(light + "\"float power\" 5 " + kPbrtTriangle), InputError);
}

TEST(PbrtShapes, MeshesHaveHolesWhereAlphaSays) {
    const Row row({0, 1});
    const PbrtScene s("Texture \"a\" \"float\" \"imagemap\" \"string filename\" \"" + row.path +
                      "\" \"string filter\" \"point\"\n"
                      "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ] \"point2 uv\" [ 0 0 1 0 0 1 ] "
                      "\"texture alpha\" \"a\" Shape \"sphere\" \"float alpha\" 0.25");
    EXPECT_EQ(s.shape(0).alpha->value(at(0.2f)), 0);
    EXPECT_EQ(s.shape(0).alpha->value(at(0.7f)), 1);
    EXPECT_EQ(s.shape(1).alpha->value(at(0)), 0.25);
    EXPECT_FALSE(s.mesh(0).uvs.empty());
}

TEST(PbrtShapes, WithoutAreaAreLeftOutAndNamed) {
    const std::string flat = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  2 0 0 ]\n";
    const PbrtScene s(flat + kPbrtTriangle + "AreaLightSource \"diffuse\" \"float power\" 3\n" + flat);
    EXPECT_EQ(s.scene.description.shapes.size(), 1u);
    EXPECT_THAT(s.warnings, testing::ElementsAre(testing::HasSubstr(":4:1: Shape \"trianglemesh\": no triangle of the "
                                                                    "mesh has an area: it is left out"),
                                                 testing::HasSubstr(":7:1: ")));
}

TEST(PbrtLights, IlluminanceIsWhatAPlaneFacingThemGets) {
    const PbrtScene sun("LightSource \"distant\" \"float illuminance\" 7 " + kPbrtTriangle);
    const SurfacePoint far = infinite_point({0, 0, -1});
    EXPECT_NEAR(luminance(sun.emitter().radiance(far, {0, 0, 1})), 7, 1e-5);
    const PbrtScene sky("LightSource \"infinite\" \"float illuminance\" 7 " + kPbrtTriangle);
    EXPECT_NEAR(luminance(sky.emitter().radiance(far, {0, 0, 1})) * kPi, 7, 1e-5);
}

TEST(PbrtLights, EnvironmentsHaveTheirPicturesUpside) {
    std::string picture = "PF\n2 2\n-1.0\n"; // rows from the bottom
    const std::vector<float> texels{0, 0, 1, 0, 0, 2, 3, 0, 0, 4, 0, 0};
    picture.append(reinterpret_cast<const char*>(texels.data()), texels.size() * sizeof(float));
    const ScratchDirectory folder;
    const std::string path = folder.write("sky.pfm", picture);
    const PbrtScene s("LightSource \"infinite\" \"string filename\" \"" + path + "\" " + kPbrtTriangle);
    const auto seen = [&](const Vec3& w) { return s.emitter().radiance(infinite_point(w.normalized()), -w); };
    // The lower half of the octahedral map has y > 0, its right half x > 0.
    EXPECT_GT(seen({0.3f, 0.4f, 0.5f}).z, 0);
    EXPECT_EQ(seen({0.3f, 0.4f, 0.5f}).x, 0);
    EXPECT_GT(seen({0.3f, -0.4f, 0.5f}).x, seen({-0.3f, -0.4f, 0.5f}).x);
    EXPECT_EQ(seen({0.3f, -0.4f, 0.5f}).z, 0);
}

/// What is warned of once, and with the directive's place.
TEST(PbrtWarnings, NameTheDirectiveAndWhatIsDone) {
    const auto warnings = [](const std::string& world, const std::string& options = "") {
        return PbrtScene(world + kPbrtTriangle, options).warnings;
    };
    EXPECT_THAT(warnings("", "Film \"rgb\" \"string sensor\" \"canon_eos_100d\""),
                ElementsAre(HasSubstr("as the eye sees it")));
    EXPECT_THAT(warnings("", "Film \"gbuffer\""), ElementsAre(HasSubstr("Film \"gbuffer\": an RGB picture is made")));
    EXPECT_THAT(warnings("", "Integrator \"ambientocclusion\""), ElementsAre(HasSubstr("shows light transport")));
    EXPECT_THAT(warnings("LightSource \"infinite\" \"point3 portal\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ] "),
                ElementsAre(HasSubstr("the portal is ignored")));
    EXPECT_THAT(warnings("Material \"diffuse\" \"float sparkle\" 1 "), ElementsAre(HasSubstr("sparkle")));
    for (const char* kind : {"plastic", "substrate", "uber"})
        EXPECT_THAT(warnings(std::string("Material \"") + kind + "\" "),
                    ElementsAre(HasSubstr("becomes a coateddiffuse")));
}

TEST(PbrtColorSpace, IsSrgbOrAnError) {
    EXPECT_NO_THROW(PbrtScene("ColorSpace \"srgb\" " + kPbrtTriangle));
    EXPECT_THROW(PbrtScene("ColorSpace \"rec2020\" " + kPbrtTriangle), InputError);
}

} // namespace
} // namespace keyhole
