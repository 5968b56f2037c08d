// Materials, textures, spectra, lights and media of pbrt's format: each becomes the model that docs/pbrt.md names.
#include "scene/geometry.h"
#include "scene/load/pbrt/spectrum.h"
#include "scene/materials/measured_media.h"
#include "support/pbrt_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

using testing::HasSubstr;

void expect_near(const Rgb& a, const Rgb& b, double tolerance = 1e-6) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

std::string error_of(const std::string& world) { return pbrt_error(world + kPbrtTriangle); }

SurfacePoint point_at(const Vec2& uv) {
    SurfacePoint p;
    p.ng = p.ns = {0, 0, 1};
    p.uv = uv;
    return p;
}

/// The BSDF for two skew directions off the mirror's, and what it does to a delta lobe.
Rgb probe(const Material& material, const Vec2& uv = {0.1f, 0.1f}) {
    const Bsdf bsdf = material.bsdf(point_at(uv));
    const Vec3 in = Vec3(0.3f, 0.2f, 0.9f).normalized(), out = Vec3(-0.2f, -0.3f, 0.9f).normalized();
    Rgb sum = bsdf.eval(in, out) + bsdf.eval(in, -out);
    for (const Event event : {Event::reflect, Event::transmit})
        if (const auto d = bsdf.delta(in, event)) sum += d->coefficient;
    return sum;
}

void expect_same(const std::string& pbrt, const MaterialPtr& wanted) {
    SCOPED_TRACE(pbrt);
    const PbrtScene scene(pbrt + kPbrtTriangle);
    const Material& made = *scene.shape().material;
    EXPECT_STREQ(made.kind(), wanted->kind()) << pbrt;
    EXPECT_GT(luminance(probe(*wanted)), 0) << pbrt;
    expect_near(probe(made), probe(*wanted), 1e-9);
}

ColorTexture color(double c) { return constant_texture(Rgb(c)); }
FloatTexture number(double x) { return constant_texture(x); }

TEST(PbrtMaterials, BecomeOurs) {
    expect_same("", make_diffuse(Rgb(0.5)));
    expect_same("Material \"diffuse\" \"rgb reflectance\" [ 0.1 0.2 0.3 ] ", make_diffuse(Rgb(0.1, 0.2, 0.3)));
    expect_same("Material \"dielectric\" ", make_dielectric(1.5, number(0), number(0)));
    expect_same("Material \"dielectric\" \"float eta\" 1.3 \"float roughness\" 0.09 ",
                make_dielectric(1.3, number(0.3), number(0.3)));
    expect_same("Material \"thindielectric\" \"float eta\" 1.4 ", make_thin_dielectric(1.4));
    expect_same("Material \"conductor\" \"rgb reflectance\" [ 0.9 0.9 0.9 ] ",
                make_conductor(color(0.9), number(0), number(0)));
    expect_same("Material \"conductor\" \"rgb eta\" [ 1 2 3 ] \"rgb k\" [ 3 2 1 ] \"float uroughness\" 0.2 \"float "
                "vroughness\" 0.4 "
                "\"bool remaproughness\" false ",
                make_conductor({1, 2, 3}, {3, 2, 1}, number(0.2), number(0.4)));
    expect_same(
        "Material \"conductor\" \"spectrum eta\" \"metal-Al-eta\" \"spectrum k\" \"metal-Al-k\" ",
        make_conductor({1.65746, 0.880369, 0.5212287}, {9.2238692, 6.2695232, 4.8370012}, number(0), number(0)));
    expect_same("Material \"coateddiffuse\" \"rgb reflectance\" [ 0.3 0.3 0.3 ] \"float roughness\" 0.04 \"float "
                "thickness\" 0.1 ",
                make_coated_diffuse(color(0.3), number(0.2), number(0.2), 1.5, number(0.1)));
    expect_same(
        "Material \"coatedconductor\" \"float interface.roughness\" 0.01 \"float conductor.roughness\" 0.04 "
        "\"rgb reflectance\" [ 0.7 0.7 0.7 ] ",
        make_coated_conductor({1.5, number(0.1), number(0.1), number(0.01)}, color(0.7), number(0.2), number(0.2)));
    expect_same("Material \"diffusetransmission\" \"rgb reflectance\" [ 0.2 0.2 0.2 ] \"rgb transmittance\" [ 0.6 0.6 "
                "0.6 ] \"float scale\" 0.5 ",
                make_diffuse_transmission(color(0.1), color(0.3)));
}

TEST(PbrtMaterials, OfTheOlderFormatBecomeTheirLikes) {
    expect_same("Material \"matte\" \"color Kd\" [ 0.3 0.2 0.1 ] ", make_diffuse(Rgb(0.3, 0.2, 0.1)));
    expect_same("Material \"mirror\" \"rgb Kr\" [ 0.4 0.4 0.4 ] ", make_mirror(Rgb(0.4)));
    expect_same("Material \"glass\" \"float index\" 1.7 ", make_glass(1.7));
    expect_same("Material \"translucent\" \"rgb Kd\" [ 0.8 0.8 0.8 ] ",
                make_diffuse_transmission(color(0.4), color(0.4)));
}

TEST(PbrtMaterials, MixesTakeTheSecondByItsAmount) {
    const std::string parts = "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 0 0 0 ]\n"
                              "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"rgb reflectance\" [ 1 1 1 ]\n";
    const auto share = [&](const std::string& mix) {
        const PbrtScene scene(parts + mix + kPbrtTriangle);
        double sum = 0;
        for (int i = 0; i < 2000; ++i)
            sum += luminance(probe(*scene.shape().material,
                                   {static_cast<float>(i % 50) / 50.3f, static_cast<float>(i / 50) / 41.7f}));
        return sum / 2000 * kPi;
    };
    EXPECT_NEAR(share("Material \"mix\" \"string materials\" [ \"a\" \"b\" ] \"float amount\" 0.2 "), 0.2, 0.04);
    EXPECT_NEAR(
        share("Material \"mix\" \"string namedmaterial1\" \"a\" \"string namedmaterial2\" \"b\" \"float amount\" 0.2 "),
        0.8, 0.04); // v3 has it the other way round
}

TEST(PbrtMaterials, MayBeNamedBeforeTheyAreMade) {
    const PbrtScene s("NamedMaterial \"m\" " + kPbrtTriangle +
                      "MakeNamedMaterial \"m\" \"string type\" \"thindielectric\"");
    EXPECT_STREQ(s.shape().material->kind(), make_thin_dielectric(1.5)->kind());
}

TEST(PbrtMaterials, AreMissedWhereTheyAreUsed) {
    const std::string error = pbrt_error("Material \"diffuse\"\nNamedMaterial \"gold\"\n\n" + kPbrtTriangle);
    EXPECT_THAT(error, HasSubstr("scene.pbrt:5:1: NamedMaterial \"gold\": found the unknown material 'gold'"));
}

TEST(PbrtMaterials, SayThatTheyReflectNoMoreThanAll) {
    const auto warnings = [](const std::string& rgb) {
        return PbrtScene("Material \"diffuse\" \"rgb reflectance\" [ " + rgb + " ] " + kPbrtTriangle +
                         "Material \"conductor\" \"rgb reflectance\" [ " + rgb + " ] " + kPbrtTriangle)
            .warnings;
    };
    EXPECT_THAT(warnings("1.5 0.5 0.5"),
                testing::ElementsAre(HasSubstr("found 1.5 in 'reflectance', expected at most 1")));
    EXPECT_THAT(warnings("1 0.5 0.5"), testing::IsEmpty());
}

TEST(PbrtMaterials, SayThatNothingIsRougherThanAlphaOne) {
    const auto warnings = [](const std::string& rough) {
        return PbrtScene("Material \"conductor\" \"float roughness\" " + rough + " " + kPbrtTriangle).warnings;
    };
    EXPECT_THAT(warnings("7"), testing::ElementsAre(HasSubstr("rougher than alpha 1: it counts as that")));
    EXPECT_THAT(warnings("1"), testing::IsEmpty());
}

TEST(PbrtMaterials, SayWhatIsWrong) {
    EXPECT_THAT(error_of("NamedMaterial \"no\" "), HasSubstr("found the unknown material 'no'"));
    EXPECT_THAT(error_of("Material \"velvet\" "), HasSubstr("found the material 'velvet', expected one of"));
    EXPECT_THAT(error_of("Material \"conductor\" \"float roughness\" -0.1 "), HasSubstr("found -0.1 as 'roughness'"));
    EXPECT_THAT(error_of("Material \"diffuse\" \"rgb reflectance\" [ 0.5 -1 0 ] "),
                HasSubstr("found -1, expected a number that is not negative"));
    EXPECT_THAT(error_of("Material \"diffuse\" \"rgb reflectance\" [ 1 1 1 1 1 1 ] "),
                HasSubstr("found 6 numbers, expected 3"));
    EXPECT_THAT(error_of("Material \"diffuse\" \"float reflectance\" 1 "), HasSubstr("expected its type to be"));
    EXPECT_THAT(error_of("Material \"diffuse\" \"texture reflectance\" \"no\" "),
                HasSubstr("found the unknown spectrum texture 'no'"));
    EXPECT_THAT(error_of("MakeNamedMaterial \"m\" \"rgb reflectance\" [1 1 1] "), HasSubstr("found no 'type'"));
    EXPECT_THAT(error_of("Material \"conductor\" \"spectrum eta\" \"metal-Xx-eta\" "),
                HasSubstr("found no spectrum and no file 'metal-Xx-eta'"));
    EXPECT_THAT(error_of("Material \"dielectric\" \"float eta\" 0 "), HasSubstr("found 0 as 'eta'"));
}

TEST(PbrtTextures, AreEvaluatedWithTheirMapping) {
    const PbrtScene s(
        "Texture \"a\" \"spectrum\" \"constant\" \"rgb value\" [ 0.2 0.4 0.6 ]\n"
        "Texture \"b\" \"spectrum\" \"scale\" \"texture tex\" \"a\" \"float scale\" 0.5\n"
        "Texture \"c\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"a\" \"texture tex2\" \"b\" \"float uscale\" 2 "
        "\"float vscale\" 2\n"
        "Texture \"d\" \"spectrum\" \"mix\" \"texture tex1\" \"c\" \"rgb tex2\" [ 1 1 1 ] \"float amount\" 0.25\n"
        "Material \"diffuse\" \"texture reflectance\" \"d\" " +
        kPbrtTriangle);
    const Material& m = *s.shape().material;
    expect_near(probe(m, {0.2f, 0.2f}) * kPi, Rgb(0.2, 0.4, 0.6) * 0.75 + Rgb(0.25));
    expect_near(probe(m, {0.7f, 0.2f}) * kPi, Rgb(0.1, 0.2, 0.3) * 0.75 + Rgb(0.25));
}

TEST(PbrtTextures, SayWhatIsWrong) {
    EXPECT_THAT(error_of("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"no.png\" "),
                HasSubstr("scene.pbrt:4:1: Texture \"imagemap\": "));
    EXPECT_THAT(error_of("Texture \"t\" \"spectrum\" \"imagemap\" "), HasSubstr("found no 'filename'"));
    EXPECT_THAT(error_of("Texture \"t\" \"spectrum\" \"dots\" "), HasSubstr("found the texture 'dots'"));
    EXPECT_THAT(error_of("Texture \"t\" \"integer\" \"constant\" "), HasSubstr("expected spectrum or float"));
    EXPECT_THAT(error_of("Texture \"t\" \"float\" \"checkerboard\" \"string mapping\" \"conical\" "),
                HasSubstr("found the mapping 'conical'"));
    EXPECT_THAT(error_of("Texture \"t\" \"float\" \"checkerboard\" \"integer dimension\" 4 "),
                HasSubstr("found a checkerboard of 4 dimensions"));
    EXPECT_THAT(error_of("Texture \"t\" \"float\" \"directionmix\" \"vector3 dir\" [ 0 0 0 ] "),
                HasSubstr("found no direction as 'dir'"));
    EXPECT_THAT(error_of("Texture \"t\" \"float\" \"fbm\" \"integer octaves\" 0 "), HasSubstr("'octaves'"));
}

Rgb light(const std::string& parameter) {
    const PbrtScene s("AreaLightSource \"diffuse\" " + parameter + " " + kPbrtTriangle);
    return s.shape().emission ? s.shape().emission->radiance : Rgb(0.0);
}

TEST(PbrtLights, AreaLightsShineByScalePowerAndExposure) {
    expect_near(light("\"rgb L\" [ 3 2 1 ] \"float scale\" 2"), {6, 4, 2});
    expect_near(light(""), {1, 1, 1});
    EXPECT_EQ(light("\"rgb L\" [ 0 0 0 ]"), Rgb(0.0));
    expect_near(light("\"float power\" 10"), Rgb(10 / (kPi * 0.5)));
    expect_near(light("\"float power\" 10 \"bool twosided\" true"), Rgb(10 / (kPi * 1.0)));
    // Each of two triangles has the power.
    const PbrtScene s("AreaLightSource \"diffuse\" \"float power\" 10 Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 "
                      "0 0 1 0 0 4 0 ] "
                      "\"integer indices\" [ 0 1 2  0 1 3 ]");
    ASSERT_EQ(s.scene.description.shapes.size(), 2u);
    expect_near(s.shape(1).emission->radiance, Rgb(10 / (kPi * 2.0)));
    const PbrtScene exposed("AreaLightSource \"diffuse\" " + kPbrtTriangle,
                            "Film \"rgb\" \"float iso\" 50 Camera \"perspective\" \"float shutterclose\" 4");
    expect_near(exposed.shape().emission->radiance, Rgb(2.0));
}

/// However many facets stand for it.
TEST(PbrtLights, PowerIsThatOfAQuadric) {
    for (const std::string shape : {"\"disk\"", "\"cylinder\"", "\"sphere\" \"float phimax\" 90", "\"sphere\""}) {
        const PbrtScene s("AreaLightSource \"diffuse\" \"float power\" 10 Shape " + shape);
        ASSERT_EQ(s.scene.description.shapes.size(), 1u) << shape;
        expect_near(s.shape().emission->radiance, Rgb(10 / (kPi * surface_area(s.shape()))));
    }
}

TEST(PbrtLights, SpectraHaveLuminanceOne) {
    EXPECT_NEAR(luminance(light("\"blackbody L\" 3000")), 1, 0.01);
    EXPECT_GT(light("\"blackbody L\" 3000").x, 2 * light("\"blackbody L\" 3000").z);
    expect_near(light("\"blackbody L\" 6500"), {1.0425, 0.9839, 1.0348}, 0.01);
    expect_near(light("\"spectrum L\" \"stdillum-D65\""), {1, 1, 1});
    EXPECT_NEAR(luminance(light("\"spectrum L\" [ 400 7 700 7 ]")), 1, 0.01);
}

TEST(PbrtLights, ReflectanceSpectraKeepGreyGrey) {
    const PbrtScene s("Material \"diffuse\" \"spectrum reflectance\" [ 300 0.4 900 0.4 ] " + kPbrtTriangle);
    expect_near(probe(*s.shape().material) * kPi / 0.4, Rgb(1.0), 1e-6);
    const PbrtScene red("Material \"diffuse\" \"spectrum reflectance\" [ 590 0 610 0.8 ] " + kPbrtTriangle);
    EXPECT_EQ(probe(*red.shape().material).z, 0);
}

TEST(PbrtLights, PointSpotDistantInfinite) {
    const auto power = [](const std::string& text) { return PbrtScene(text + kPbrtTriangle).emitter().power(); };
    EXPECT_NEAR(power("LightSource \"point\" \"rgb I\" [ 2 2 2 ] \"float scale\" 3 "), 24 * kPi, 1e-4);
    EXPECT_NEAR(power("LightSource \"point\" \"float power\" 7 "), 7, 1e-6);
    EXPECT_NEAR(power("LightSource \"spot\" \"float power\" 7 \"float coneangle\" 40 "), 7, 1e-6);
    const PbrtScene spot("Translate 0 0 5 LightSource \"spot\" \"point3 from\" [ 1 0 0 ] \"point3 to\" [ 1 0 -1 ] " +
                         kPbrtTriangle);
    SurfacePoint at;
    at.site = Site::point;
    EXPECT_EQ(spot.emitter().radiance(at, {0, 0, -1}), Rgb(1.0));
    EXPECT_EQ(spot.emitter().radiance(at, {0, 0, 1}), Rgb(0.0));
    EXPECT_EQ(PbrtScene("LightSource \"distant\" " + kPbrtTriangle).scene.description.emitters.size(), 1u);
    PbrtScene two("LightSource \"infinite\" LightSource \"infinite\" \"rgb L\" [ 2 2 2 ] " + kPbrtTriangle);
    EXPECT_EQ(Scene(std::move(two.scene.description)).emitters().size(), 1u) << "a miss meets them all";
    EXPECT_TRUE(
        PbrtScene("LightSource \"point\" \"rgb I\" [ 0 0 0 ] " + kPbrtTriangle).scene.description.emitters.empty());
}

TEST(PbrtLights, SayWhatIsWrong) {
    EXPECT_THAT(error_of("LightSource \"goniometric\" "), HasSubstr("found no 'filename'"));
    EXPECT_THAT(error_of("LightSource \"projection\" \"string filename\" \"no.exr\" "),
                HasSubstr("scene.pbrt:4:1: LightSource \"projection\": "));
    EXPECT_THAT(error_of("LightSource \"laser\" "), HasSubstr("found the light 'laser', expected one of"));
    EXPECT_THAT(error_of("LightSource \"infinite\" \"string mapname\" \"a.exr\" "),
                HasSubstr("longitude and latitude"));
    EXPECT_THAT(error_of("LightSource \"infinite\" \"string filename\" \"no.exr\" "),
                HasSubstr("scene.pbrt:4:1: LightSource \"infinite\": "));
    EXPECT_THAT(error_of("LightSource \"distant\" \"point3 to\" [ 0 0 0 ] "),
                HasSubstr("found 'from' and 'to' at one place"));
    EXPECT_THAT(error_of("LightSource \"spot\" \"float conedeltaangle\" 50 "),
                HasSubstr("found 50 as 'conedeltaangle'"));
    EXPECT_THAT(error_of("AreaLightSource \"diffuse\" \"rgb L\" [ -1 0 0 ] "),
                HasSubstr("found -1, expected a number that is not negative"));
    EXPECT_THAT(error_of("AreaLightSource \"diffuse\" \"blackbody L\" -5 "), HasSubstr("found -5 kelvin"));
}

TEST(PbrtMedia, AbsorbAndScatter) {
    const std::string tea = "MakeNamedMedium \"tea\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [ 1 2 3 ] \"rgb "
                            "sigma_s\" [ 0 0 0 ] \"float scale\" 2 ";
    const PbrtScene s(tea + "MediumInterface \"tea\" \"\" Material \"interface\" " + kPbrtTriangle + kPbrtTriangle);
    ASSERT_NE(s.shape().inside, nullptr);
    EXPECT_EQ(s.shape().inside->absorption, Rgb(2, 4, 6));
    EXPECT_EQ(s.shape(0).inside, s.shape(1).inside);
    EXPECT_EQ(s.shape().outside, nullptr);
    const PbrtScene under(kPbrtTriangle, tea + "MediumInterface \"\" \"tea\" Camera \"perspective\" ");
    EXPECT_EQ(under.scene.description.medium->absorption, Rgb(2, 4, 6));
    const std::string in_fog = kPbrtTriangle, fog = "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" ",
                      camera = " MediumInterface \"\" \"fog\" Camera \"perspective\" ";
    const auto medium = [&](const std::string& parameters) {
        return PbrtScene(in_fog, fog + parameters + camera).scene.description.medium;
    };
    EXPECT_EQ(medium("\"float scale\" 10")->scattering, Rgb(25.5, 32.1, 37.7)) << "pbrt's own";
    EXPECT_NEAR(medium("")->absorption.z, 0.014, 1e-6);
    const auto thick = medium("\"rgb sigma_a\" [ 0 0 0 ] \"rgb sigma_s\" [ 3 2 1 ] \"float g\" 0.5");
    EXPECT_EQ(thick->extinction(), Rgb(3, 2, 1));
    EXPECT_EQ(thick->anisotropy, 0.5f);
    EXPECT_EQ(thick->density, nullptr);
    const auto milk = medium("\"string preset\" \"Wholemilk\"");
    EXPECT_EQ(milk->scattering, measured_media().at("Wholemilk").reduced_scattering);
    EXPECT_THAT(error_of("MediumInterface \"no\" \"\" "), HasSubstr("found the unknown medium 'no'"));
}

TEST(PbrtMedia, VaryOverAGrid) {
    const std::string grid = "Scale 2 2 2 MakeNamedMedium \"smoke\" \"string type\" \"uniformgrid\" \"integer nx\" 2 "
                             "\"point3 p1\" [ 2 1 1 ] ",
                      use = "Identity MediumInterface \"smoke\" \"\" Material \"interface\" " + kPbrtTriangle;
    const PbrtScene s(grid + "\"float density\" [ 1 3 ] \"rgb sigma_a\" [ 0 1 2 ] " + use);
    const auto smoke = s.shape().inside;
    ASSERT_NE(smoke, nullptr);
    ASSERT_NE(smoke->density, nullptr);
    EXPECT_EQ(smoke->absorption, Rgb(0, 1, 2));
    EXPECT_EQ(smoke->scattering, Rgb(1.0));
    EXPECT_NEAR(smoke->density->density({1, 1, 1}), 1, 1e-6) << "the world is twice as large";
    EXPECT_NEAR(smoke->density->density({3, 1, 1}), 3, 1e-6);
    EXPECT_THAT(error_of(grid + "\"float density\" [ 1 3 2 ] " + use), HasSubstr("found 3 numbers in 'density'"));
    EXPECT_THAT(error_of(grid + "\"float density\" [ 1 -3 ] " + use), HasSubstr("found the density -3"));
    EXPECT_THAT(error_of(grid + "\"float density\" [ 1 3 ] \"point3 p0\" [ 2 0 0 ] " + use), HasSubstr("beyond 'p0'"));
    EXPECT_THAT(error_of(grid + "\"float density\" [ 1 3 ] \"rgb Le\" [ 1 1 1 ] " + use), HasSubstr("emits"));
    EXPECT_THAT(error_of("MakeNamedMedium \"smoke\" \"string type\" \"cloud\" " + use), HasSubstr("type 'cloud'"));
    EXPECT_EQ(error_of("MakeNamedMedium \"smoke\" \"string type\" \"cloud\" "), "") << "nothing is in it";
}

TEST(PbrtMaterials, OfIndicesGivenAsColoursTakeTheMiddleOfRedAndGreen) {
    expect_same("Material \"dielectric\" \"rgb eta\" [ 1.3 1.5 1.8 ] ", make_dielectric(1.4, number(0), number(0)));
    const PbrtScene colours("Material \"dielectric\" \"rgb eta\" [ 1.3 1.5 1.8 ] " + kPbrtTriangle);
    EXPECT_THAT(colours.warnings,
                testing::ElementsAre(HasSubstr("one refractive index, halfway between red and green")));
    EXPECT_TRUE(PbrtScene("Material \"dielectric\" \"rgb eta\" [ 1.5 1.5 1.5 ] " + kPbrtTriangle).warnings.empty());
    EXPECT_THAT(error_of("Material \"thindielectric\" \"rgb eta\" [ 0 0 0 ] "), HasSubstr("found 0 as 'eta'"));
}

TEST(PbrtShapes, KeepTheirAlpha) {
    const PbrtScene s("Texture \"t\" \"float\" \"checkerboard\" Shape \"sphere\" \"texture alpha\" \"t\" " +
                      kPbrtTriangle);
    EXPECT_NE(s.shape(0).alpha, nullptr);
    EXPECT_EQ(s.shape(1).alpha, nullptr);
}

TEST(PbrtShapes, ShineUnseenWhereTheirAlphaIsZero) {
    PbrtScene s("AttributeBegin Translate 5 0 0 " + kPbrtTriangle +
                "AttributeEnd AreaLightSource \"diffuse\" \"rgb L\" [ 2 2 2 ] Shape \"sphere\" \"float alpha\" 0");
    const Scene scene(std::move(s.scene.description));
    ASSERT_EQ(scene.emitters().size(), 1u);
    EXPECT_TRUE(scene.emitter(0).is_delta());
    Rng rng(1, StreamPurpose::test, 0);
    const SurfacePoint point = scene.emitter(0).sample_point(rng).point;
    EXPECT_NEAR(luminance(scene.emitter(0).radiance(point, point.ng)), 2, 1e-6);
    EXPECT_FALSE(scene.trace(scene.camera().eye(0.5, 0.5), Vec3(0, 0, 1)).has_value());
}

} // namespace
} // namespace keyhole
