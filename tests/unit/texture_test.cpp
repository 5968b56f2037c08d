// Textures, the images behind them, and what materials make of them.
#include "core/error.h"
#include "scene/geometry.h"
#include "scene/images/image.h"
#include "scene/material.h"
#include "scene/shape.h"
#include "support/scratch_directory.h"

#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

SurfacePoint at(float u, float v) {
    SurfacePoint s;
    s.uv = {u, v};
    s.ng = s.ns = Vec3(0, 0, 1);
    s.shape = s.primitive = 0;
    return s;
}

void append(std::string& bytes, float x) { bytes.append(reinterpret_cast<const char*>(&x), sizeof x); }

/// 2 x 2 grey floats; PFM starts at the bottom row.
std::string small_pfm() {
    std::string bytes = "Pf\n2 2\n-1.0\n";
    for (const float x : {1.0f, 2.0f, 3.0f, 4.0f}) append(bytes, x); // bottom: 1 2, top: 3 4
    return bytes;
}

/// A binary PPM, 8 bits a channel: what OpenImageIO reads without any compression.
std::string small_ppm() { return std::string("P6\n2 1\n255\n") + std::string("\x00\x80\xff\xff\x40\x00", 6); }

/// Each has the one before it twice: to ask them all would take 2^60 questions.
TEST(Texture_OfConstants, IsAConstantHoweverDeepItIsNested) {
    FloatTexture t = constant_texture(0.5);
    for (int i = 0; i < 60; ++i) t = scale_texture<double>(mix_texture<double>(t, t, t), constant_texture(1.0));
    EXPECT_TRUE(t->is_constant());
    EXPECT_NEAR(t->value(at(0.1f, 0.2f)), 0.5, 1e-12);
    MaterialPtr m = make_diffuse(Rgb(0.5));
    for (int i = 0; i < 60; ++i) m = make_mix(m, m, constant_texture(0.5));
    EXPECT_TRUE(m->traits().diffuse);
    EXPECT_EQ(m->surface().alpha, nullptr);
    EXPECT_EQ(m->finite_share(), nullptr);
}

TEST(ImageTexture_Alpha, IsAChannelOfItsOwnAndOneWhereThereIsNone) {
    const ScratchDirectory scratch;
    // A header, then one pixel: blue, green, red, alpha.
    std::string tga(18, '\0');
    tga[2] = 2, tga[12] = 1, tga[14] = 1, tga[16] = 32, tga[17] = 8;
    tga += "\x10\x20\x40\x33";
    const std::string file = scratch.write("a.tga", tga);
    EXPECT_NEAR(image_texture<double>(file, {.channel = 3})->value(at(0.5f, 0.5f)), 0.2, 1e-6);
    EXPECT_NEAR(image_texture<double>(file, {.encoding = Encoding::linear, .channel = 0})->value(at(0.5f, 0.5f)),
                64 / 255.0, 1e-6);
    const FloatTexture none = image_texture<double>(scratch.write("b.pfm", small_pfm()), {.channel = 3});
    EXPECT_TRUE(none->is_constant());
    EXPECT_EQ(none->value(at(0.5f, 0.5f)), 1);
}

TEST(ImageTexture_Rows, RunFromTheTop) {
    const ScratchDirectory scratch;
    const auto t = image_texture<double>(scratch.write("a.pfm", small_pfm()), {.filter = Filter::nearest});
    EXPECT_EQ(t->value(at(0.1f, 0.1f)), 1);
    EXPECT_EQ(t->value(at(0.9f, 0.1f)), 2);
    EXPECT_EQ(t->value(at(0.1f, 0.9f)), 3);
    EXPECT_EQ(t->value(at(0.9f, 0.9f)), 4);
}

TEST(ImageTexture_Bilinear, IsExactAtCentresAndMeansBetween) {
    const ScratchDirectory scratch;
    const auto t = image_texture<double>(scratch.write("a.pfm", small_pfm()), {});
    EXPECT_DOUBLE_EQ(t->value(at(0.25f, 0.25f)), 1);
    EXPECT_DOUBLE_EQ(t->value(at(0.5f, 0.25f)), 1.5);
    EXPECT_DOUBLE_EQ(t->value(at(0.5f, 0.5f)), 2.5);
}

TEST(ImageTexture_Wrap, RepeatsClampsOrEnds) {
    const ScratchDirectory scratch;
    const std::string file = scratch.write("a.pfm", small_pfm());
    const auto value = [&](Wrap wrap, float u, float v) {
        return image_texture<double>(file, {.wrap = wrap, .filter = Filter::nearest})->value(at(u, v));
    };
    EXPECT_EQ(value(Wrap::repeat, 1.1f, -0.9f), 1);
    EXPECT_EQ(value(Wrap::repeat, -0.1f, 0.1f), 2);
    EXPECT_EQ(value(Wrap::clamp, -3, 0.1f), 1);
    EXPECT_EQ(value(Wrap::clamp, 7, 9), 4);
    EXPECT_EQ(value(Wrap::black, 1.1f, 0.1f), 0);
    EXPECT_EQ(value(Wrap::repeat, NAN, INFINITY), 0);
}

TEST(ImageTexture_Options, MapScaleAndInvert) {
    const ScratchDirectory scratch;
    const std::string file = scratch.write("a.pfm", small_pfm());
    ImageOptions options{.filter = Filter::nearest, .scale = 0.25, .invert = true};
    options.mapping.uv = {.su = 2, .sv = 2, .du = 0.5, .dv = 0};
    EXPECT_EQ(image_texture<double>(file, options)->value(at(0, 0.1f)), 1 - 2 * 0.25);
}

TEST(ImageTexture_EightBits, AreDecodedAndKeptAsBytes) {
    const ScratchDirectory scratch;
    const std::string file = scratch.write("a.ppm", small_ppm());
    const auto srgb = image_texture<Rgb>(file, {.filter = Filter::nearest});
    const Rgb c = srgb->value(at(0.1f, 0.5f));
    EXPECT_EQ(c.x, 0);
    EXPECT_NEAR(c.y, 0.2158605, 1e-5); // 128 of 255 in sRGB
    EXPECT_EQ(c.z, 1);
    const auto linear = image_texture<Rgb>(file, {.encoding = Encoding::linear, .filter = Filter::nearest});
    EXPECT_NEAR(linear->value(at(0.1f, 0.5f)).y, 128.0 / 255, 1e-6);
    const auto gamma = image_texture<Rgb>(file, {.encoding = Encoding::gamma, .gamma = 2, .filter = Filter::nearest});
    EXPECT_NEAR(gamma->value(at(0.1f, 0.5f)).y, 128.0 * 128 / 255 / 255, 1e-6);
    const auto images = loaded_images();
    ASSERT_EQ(images.size(), 1u) << "three textures share it";
    EXPECT_EQ(images[0].bytes, 6u);
}

TEST(ImageTexture_Files, OfEmittersAreListedByWholePathsAsAllAre) {
    const auto picture = note_picture({"lamp.exr", 1, 1, 1, 4, 0});
    EXPECT_EQ(picture->path, (std::filesystem::current_path() / "lamp.exr").string());
}

TEST(ImageTexture_Files, ThatAreBrokenSaySo) {
    const ScratchDirectory scratch;
    const std::vector<std::string> broken{
        scratch.path("missing.png"),
        scratch.write("empty.pfm", ""),
        scratch.write("short.pfm", "PF\n2 2\n-1.0\nabc"),
        scratch.write("huge.pfm", "PF\n60000 60000\n-1.0\n"),
        scratch.write("text.exr", "no picture"),
        scratch.write("text.png", "no picture"),
        scratch.write("text.unknown", "no picture"),
    };
    for (const auto& file : broken) {
        try {
            image_texture<Rgb>(file, {});
            ADD_FAILURE() << file;
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find(file), std::string::npos) << e.what();
        }
    }
}

TEST(Checkerboard_Squares, AlternateThroughTheOrigin) {
    const auto t =
        checkerboard_texture<double>(constant_texture(1.0), constant_texture(2.0), {.uv = {.su = 4, .sv = 4}});
    EXPECT_EQ(t->value(at(0.1f, 0.1f)), 1);
    EXPECT_EQ(t->value(at(0.3f, 0.1f)), 2);
    EXPECT_EQ(t->value(at(0.3f, 0.3f)), 1);
    EXPECT_EQ(t->value(at(-0.1f, 0.1f)), 2);
}

TEST(ComposedTextures, MixAndScale) {
    const FloatTexture one = constant_texture(1.0), three = constant_texture(3.0), share = constant_texture(0.25);
    EXPECT_DOUBLE_EQ(mix_texture<double>(one, three, share)->value(at(0, 0)), 1.5);
    EXPECT_DOUBLE_EQ(scale_texture<double>(three, share)->value(at(0, 0)), 0.75);
    EXPECT_TRUE(mix_texture<double>(one, three, share)->is_constant());
}

TEST(Alpha_Screen, HasItsShareOfMatterAndLooksTheSameTwice) {
    int matter = 0;
    constexpr int kPlaces = 20000;
    const FloatTexture alpha = constant_texture(0.3);
    for (int i = 0; i < kPlaces; ++i) {
        const SurfacePoint p =
            at(static_cast<float>(std::fmod(i * 0.754877666, 1)), static_cast<float>(std::fmod(i * 0.569840296, 1)));
        matter += is_opaque(alpha, p) ? 1 : 0;
        EXPECT_EQ(is_opaque(alpha, p), is_opaque(alpha, p));
        EXPECT_TRUE(is_opaque(constant_texture(1.0), p));
        EXPECT_FALSE(is_opaque(constant_texture(0.0), p));
        EXPECT_TRUE(is_opaque(nullptr, p));
    }
    EXPECT_NEAR(matter / double{kPlaces}, 0.3, 0.02);
}

TEST(MixMaterial, ChoosesByShareAndNestedOnesApart) {
    const auto a = make_diffuse(Rgb(0.1)), b = make_mirror(Rgb(1.0)), c = make_black();
    const auto inner = make_mix(a, b, constant_texture(0.5)), outer = make_mix(inner, c, constant_texture(0.5));
    std::array<int, 3> counts{};
    for (int i = 0; i < 8000; ++i) {
        const SurfacePoint p = at(static_cast<float>(std::fmod(i * 0.754877666, 1)), 0.3f);
        const BsdfTraits t = outer->bsdf(p).traits();
        ++counts[t.finite ? 0 : t.delta ? 1 : 2];
    }
    EXPECT_NEAR(counts[0], 2000, 200);
    EXPECT_NEAR(counts[1], 2000, 200);
    EXPECT_NEAR(counts[2], 4000, 250);
    EXPECT_TRUE(outer->traits().finite && outer->traits().delta);
}

TEST(Materials_Roughness, UpToAThousandthIsSmooth) {
    const auto traits = [](double alpha) {
        return make_conductor(Rgb(0.2), Rgb(3.0), constant_texture(alpha), constant_texture(alpha))->traits();
    };
    EXPECT_TRUE(traits(0.001).delta);
    EXPECT_FALSE(traits(0.001).finite);
    EXPECT_TRUE(traits(0.0011).finite);
    EXPECT_FALSE(traits(0.0011).delta);
}

TEST(Materials_Conductor, ReflectsItsReflectanceAtNormalIncidence) {
    const Rgb wanted(0.9, 0.5, 0.04);
    const auto smooth = constant_texture(0.0);
    const Bsdf bsdf = make_conductor(constant_texture(wanted), smooth, smooth)->bsdf(at(0, 0));
    const Rgb got = bsdf.delta(Vec3(0, 0, 1), Event::reflect)->coefficient;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], wanted[k], 1e-5);
}

TEST(Materials_Coats, KeepTheirInterfaceAlive) {
    // No other coat has this index, so that the cache alone would let go of it.
    constexpr double kIndex = 1.61803;
    const auto zero = constant_texture(0.0), rough = constant_texture(0.2);
    const auto material = make_coated_diffuse(constant_texture(Rgb(0.5)), rough, rough, kIndex, zero);
    const CoatInterface own(kIndex);
    const Vec3 a = Vec3(0.1f, 0.2f, 0.9f).normalized(), b = Vec3(0.4f, -0.2f, 0.6f).normalized();
    const double expected = CoatedDiffuseBsdf(own, Rgb(0.5), 0.2, 0.2, 0).eval(a, b).x;
    const CoatInterface other(1.3); // may take the place of what was let go
    SurfacePoint p = at(0, 0);
    p.tangent = Vec3(1, 0, 0);
    EXPECT_NEAR(material->bsdf(p).eval(a, b).x, expected, 1e-5 * expected);
}

/// Metres of height over texture coordinates: 0.3 u - 0.2 v.
class Slope final : public Texture<double> {
    double value(const SurfacePoint& p) const override { return 0.3 * p.uv.x - 0.2 * p.uv.y; }
};

TEST(Bump_Normal, IsThatOfTheDisplacedTriangle) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 1}, {0.5f, 1.5f, 0}};
    mesh.triangles = {{0, 1, 2}};
    mesh.uvs = {{0.1f, 0}, {0.6f, 0.1f}, {0.2f, 0.9f}};
    const SurfacePoint p = triangle_point(mesh, 0, 0.3f, 0.3f);
    // The same triangle moved corner by corner.
    TriangleMesh moved = mesh;
    for (std::size_t i = 0; i < 3; ++i) moved.positions[i] += p.ng * (0.3f * mesh.uvs[i].x - 0.2f * mesh.uvs[i].y);
    const Vec3 expected = triangle_point(moved, 0, 0.3f, 0.3f).ng;
    const auto material = with_bump(make_diffuse(Rgb(0.5)), std::make_shared<Slope>());
    EXPECT_LT((material->bsdf(p).shading_normal() - expected).length(), 1e-3);
    EXPECT_GT((p.ng - expected).length(), 0.05);
    // Mirrored texture coordinates turn nothing around.
    for (Vec2& uv : mesh.uvs) std::swap(uv.x, uv.y);
    EXPECT_GT(material->bsdf(triangle_point(mesh, 0, 0.3f, 0.3f)).shading_normal().dot(p.ng), 0.5f);
}

TEST(Point_WithoutParametrisation, IsTheSamePlace) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 1}, {0.5f, 1.5f, 0}};
    mesh.normals = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 0.6f, 0.8f}};
    mesh.triangles = {{0, 1, 2}};
    const Sphere sphere{Vec3(1, 2, 3), 2.5f};
    const Vec3 outward = Vec3(1, -2, 0.5f).normalized();
    for (const auto& [with, without] :
         {std::pair(triangle_point(mesh, 0, 0.3f, 0.2f), triangle_point(mesh, 0, 0.3f, 0.2f, false)),
          std::pair(sphere_point(sphere, outward), sphere_point(sphere, outward, false))}) {
        EXPECT_EQ(with.p, without.p);
        EXPECT_EQ(with.ng, without.ng);
        EXPECT_EQ(with.ns, without.ns);
        EXPECT_EQ(with.offset, without.offset);
        EXPECT_EQ(with.primitive, without.primitive);
        EXPECT_LT((with.shading_frame().s - with.tangent).length(), 1e-5f);
        const Frame frame = without.shading_frame();
        EXPECT_EQ(frame.n, without.ns);
        EXPECT_LT((frame.s.cross(frame.t) - frame.n).length(), 1e-5f);
    }
}

TEST(Materials, TellWhetherTheyReadAParametrisation) {
    const auto zero = constant_texture(0.0), rough = constant_texture(0.2);
    const auto slope = std::make_shared<Slope>();
    const auto grey = constant_texture(Rgb(0.5)),
               tiles = checkerboard_texture(grey, constant_texture(Rgb(0.1)), TextureMapping{});
    EXPECT_FALSE(make_diffuse(grey)->reads_parametrisation());
    EXPECT_TRUE(make_diffuse(tiles)->reads_parametrisation());
    EXPECT_FALSE(make_glass(1.5)->reads_parametrisation());
    EXPECT_FALSE(make_mirror(Rgb(0.9))->reads_parametrisation());
    EXPECT_TRUE(make_conductor(grey, rough, constant_texture(0.05))->reads_parametrisation()); // has a direction
    EXPECT_FALSE(make_conductor(grey, zero, zero)->reads_parametrisation());
    EXPECT_TRUE(with_bump(make_diffuse(grey), slope)->reads_parametrisation());
    EXPECT_TRUE(make_mix(make_diffuse(grey), make_glass(1.5), rough)->reads_parametrisation());
}

TEST(SpherePoint_Derivatives, AreThoseOfItsParametrisation) {
    const Sphere sphere{Vec3(1, 2, 3), 2.5f};
    const auto point = [&](double u, double v) {
        const double phi = 2 * kPi * u, theta = kPi * v;
        return sphere_point(sphere, Vec3(Imath::V3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                                    std::cos(theta))));
    };
    const SurfacePoint p = point(0.2, 0.3);
    const Vec3 du = (point(0.205, 0.3).p - point(0.195, 0.3).p) / 0.01f;
    const Vec3 dv = (point(0.2, 0.305).p - point(0.2, 0.295).p) / 0.01f;
    const Vec3 across = p.ns.cross(p.tangent);
    EXPECT_LT((p.tangent * p.dpdu - du).length(), 0.02);
    EXPECT_LT((p.tangent * p.dpdv.x + across * p.dpdv.y - dv).length(), 0.02);
}

} // namespace
} // namespace keyhole
