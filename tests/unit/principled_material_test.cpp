// The principled material in scene files, ours and pbrt's.
#include "core/error.h"
#include "scene/load/load.h"
#include "support/pbrt_scenes.h"
#include "support/scratch_directory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace keyhole {
namespace {

using testing::HasSubstr;

class PrincipledMaterial : public testing::Test {
  protected:
    Shape shape(const std::string& material, const std::string& more = "") {
        auto scene = load_scene(directory_.write("s.yaml", "camera: {from: [0, 0, 3], to: [0, 0, 0]}\n"
                                                           "shapes: [{type: sphere, material: {" +
                                                               material + "}" + more + "}]\n"),
                                {});
        return std::move(scene.description.shapes.front());
    }
    Bsdf::Model model(const std::string& material, const Vec2& uv = {0, 0}) {
        SurfacePoint point;
        point.uv = uv;
        point.shape = point.primitive = 0;
        return shape(material).material->bsdf(point).model();
    }
    std::string error(const std::string& material, const std::string& more = "") {
        try {
            shape(material, more);
        } catch (const InputError& e) {
            return e.what();
        }
        return "";
    }

  private:
    ScratchDirectory directory_;
};

/// What a model makes of light from one skew direction in another, and of a delta lobe.
Rgb probe(const Bsdf::Model& model) {
    const Bsdf bsdf(Frame(), model);
    const Vec3 in = Vec3(0.3f, 0.2f, 0.9f).normalized(), out = Vec3(-0.2f, -0.3f, 0.9f).normalized();
    Rgb sum = bsdf.eval(in, out);
    if (const auto d = bsdf.delta(in, Event::reflect)) sum += d->coefficient * 100;
    return sum;
}

void expect_same(const Bsdf::Model& a, const PrincipledParameters& b) {
    ASSERT_TRUE(std::holds_alternative<PrincipledBsdf>(a));
    const Rgb x = probe(a), y = probe(PrincipledBsdf(b));
    EXPECT_GT(luminance(y), 0);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(x[k], y[k], 1e-5 * y[k]);
}

TEST_F(PrincipledMaterial, HasBurleysDefaultsAndScales) {
    PrincipledParameters p;
    expect_same(model("type: principled"), p);
    p.alpha_x = p.alpha_y = 0.09;
    p.specular = 0.08;
    p.specular_tint = 0.25;
    p.metallic = 0.125;
    p.coat = 0.25;
    p.coat_alpha = 0.04;
    p.sheen = 0.75;
    p.sheen_tint = 1;
    p.base_color = Rgb(0.5, 0.25, 0.125);
    expect_same(model("type: principled, base_color: [0.5, 0.25, 0.125], roughness: 0.3, specular: 1, specular_tint: "
                      "0.25, metallic: 0.125, clearcoat: 1, clearcoat_roughness: 0.2, sheen: 0.75, sheen_tint: 1"),
                p);
}

TEST_F(PrincipledMaterial, StretchesItsGlossAlongTheTangent) {
    PrincipledParameters p;
    p.alpha_x = 0.25 / std::sqrt(0.28);
    p.alpha_y = 0.25 * std::sqrt(0.28);
    expect_same(model("type: principled, anisotropy: 0.8"), p);
}

TEST_F(PrincipledMaterial, TakesItsReflectanceFromTheIndexUnlessGiven) {
    PrincipledParameters p;
    p.specular = 1.0 / 9; // of index 2
    expect_same(model("type: principled, ior: 2"), p);
    p.specular = 0.04;
    expect_same(model("type: principled, ior: 2, specular: 0.5"), p);
}

TEST_F(PrincipledMaterial, IsASimplerOneWhereItCan) {
    EXPECT_TRUE(std::holds_alternative<DiffuseBsdf>(model("type: principled, specular: 0")));
    EXPECT_TRUE(std::holds_alternative<GlassBsdf>(model("type: principled, transmission: 1, roughness: 0")));
    const auto ground = model("type: principled, transmission: 1, base_color: [1, 0.25, 0], ior: 1.4");
    const auto& glass = std::get<RoughDielectricBsdf>(ground);
    EXPECT_FLOAT_EQ(glass.eta, 1.4f);
    EXPECT_FLOAT_EQ(glass.alpha_x, 0.25f);
    EXPECT_EQ(Rgb(glass.transmit_tint), Rgb(1, 0.5, 0)) << "light goes in and out";
    EXPECT_EQ(Rgb(glass.reflect_tint), Rgb(1.0));
    EXPECT_FALSE(shape("type: principled, specular: 0").material->traits().delta);
    EXPECT_TRUE(shape("type: principled, specular: 0").material->traits().diffuse);
}

TEST_F(PrincipledMaterial, IsGlassByItsShareWhereItIsNoMetal) {
    const auto share = [&](const std::string& values) {
        const Shape made = shape("type: principled, " + values);
        int glass = 0;
        for (int i = 0; i < 4000; ++i) {
            SurfacePoint point;
            point.uv = {static_cast<float>(i % 50) / 50.3f, static_cast<float>(i / 50) / 81.7f};
            glass += std::holds_alternative<RoughDielectricBsdf>(made.material->bsdf(point).model());
        }
        return glass / 4000.0;
    };
    EXPECT_NEAR(share("transmission: 0.7"), 0.7, 0.04);
    EXPECT_NEAR(share("transmission: 0.8, metallic: 0.5"), 0.4, 0.04);
    EXPECT_EQ(share("transmission: 1, metallic: 1"), 0);
}

TEST_F(PrincipledMaterial, VariesByTextures) {
    const std::string board = "{type: checkerboard, a: 0, b: 1}";
    for (const char* key :
         {"metallic", "roughness", "anisotropy", "specular", "specular_tint", "clearcoat", "sheen", "base_color"}) {
        const std::string material =
            "type: principled, base_color: [0.6, 0.2, 0.1], " + std::string(key) + ": " + board;
        const std::string plain =
            key == std::string("base_color") ? "type: principled, base_color: " + board : material;
        EXPECT_GT((probe(model(plain, {0.5f, 0.5f})) - probe(model(plain, {1.5f, 0.5f}))).length(), 1e-6) << key;
    }
}

TEST_F(PrincipledMaterial, HandsEmissionAndAlphaToItsShapes) {
    const std::string lamp = "type: principled, emission: [1, 2, 3], alpha: 0.5";
    const Shape made = shape(lamp);
    ASSERT_NE(made.emission, nullptr);
    EXPECT_EQ(made.emission->radiance, Rgb(1, 2, 3));
    EXPECT_TRUE(made.emission->two_sided);
    EXPECT_EQ(made.alpha->value({}), 0.5);
    const Shape own =
        shape(lamp + ", bump: {type: checkerboard, a: 0, b: 1}", ", alpha: 0.25, emission: {radiance: 5}");
    EXPECT_EQ(own.emission->radiance, Rgb(5.0));
    EXPECT_EQ(own.alpha->value({}), 0.25);
    EXPECT_EQ(shape("type: principled").emission, nullptr);
    EXPECT_EQ(shape("type: principled").alpha, nullptr);
}

TEST_F(PrincipledMaterial, KeepsItsOpacityInMixes) {
    const Shape made = shape("type: mix, amount: 0.5, a: {type: principled, alpha: 0}, b: {type: diffuse}");
    int holes = 0;
    for (int i = 0; i < 1000; ++i) {
        SurfacePoint point;
        point.uv = {static_cast<float>(i) / 1000.7f, 0.3f};
        const bool opaque = made.alpha->value(point) == 1;
        holes += !opaque;
        EXPECT_EQ(opaque, std::holds_alternative<DiffuseBsdf>(made.material->bsdf(point).model()));
    }
    EXPECT_NEAR(holes, 500, 80);
    EXPECT_THAT(error("type: mix, a: {type: principled, emission: 1}, b: {type: diffuse}"),
                HasSubstr("found a mix of a material with 'emission', expected 'emission' of the shape"));
}

TEST_F(PrincipledMaterial, SaysWhatIsWrong) {
    for (const auto& [values, message] : std::vector<std::pair<const char*, const char*>>{
             {"metallic: 1.5", "found the value '1.5', expected a share"},
             {"roughness: -1", "found the value '-1', expected a roughness"},
             {"clearcoat: 5", "found the value '5', expected an amount of clearcoat of at least 0 and at most 4"},
             {"emission: -1", "found the value '-1', expected an amount of light"},
             {"ior: 0", "found the value '0', expected a refractive index"},
             {"base_colour: 1", "found the unknown key 'base_colour' in a principled material"}}) {
        const std::string found = error(std::string("type: principled, ") + values);
        EXPECT_THAT(found, HasSubstr(message));
        EXPECT_THAT(found, HasSubstr("s.yaml:2:")) << values;
    }
}

TEST_F(PrincipledMaterial, HasPlasticForASpecialCase) {
    PrincipledParameters p;
    p.base_color = Rgb(0.7, 0.1, 0.1);
    p.alpha_x = p.alpha_y = 0.01;
    p.specular = std::pow(0.4 / 2.4, 2);
    expect_same(model("type: plastic, base_color: [0.7, 0.1, 0.1], roughness: 0.1, ior: 1.4"), p);
    EXPECT_THAT(error("type: plastic, metallic: 1"), HasSubstr("metallic"));
}

TEST(PbrtDisney, IsPrincipled) {
    const PbrtScene scene(
        "Material \"disney\" \"rgb color\" [0.4 0.5 0.6] \"float metallic\" 0.25 \"float roughness\" "
        "0.4 \"float eta\" 1.6 \"float clearcoat\" 1 \"float clearcoatgloss\" 0.5 \"float sheen\" 0.3 "
        "\"float anisotropic\" 0.5 \"float speculartint\" 0.1 \"float sheentint\" 0.2 " +
        kPbrtTriangle);
    PrincipledParameters p;
    p.base_color = Rgb(0.4, 0.5, 0.6);
    p.metallic = 0.25;
    const double aspect = std::sqrt(1 - 0.9 * 0.5);
    p.alpha_x = 0.16 / aspect;
    p.alpha_y = 0.16 * aspect;
    p.specular = std::pow(0.6 / 2.6, 2);
    p.coat = 0.25;
    p.coat_alpha = 0.0505;
    p.sheen = 0.3;
    p.sheen_tint = 0.2;
    p.specular_tint = 0.1;
    expect_same(scene.shape().material->bsdf({}).model(), p);
}

} // namespace
} // namespace keyhole
