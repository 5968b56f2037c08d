// Extensions of glTF's materials and textures, by what becomes of them.
#include "scene/load/load_mesh.h"
#include "support/gltf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace keyhole {
namespace {

using nlohmann::json;
using test::GltfFile;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A tetrahedron, with or without its fourth face.
GltfFile& with_tetrahedron(GltfFile& file, bool closed = true) {
    const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::vector<std::uint16_t> corners{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    if (!closed) corners.resize(9);
    file.attribute("POSITION", file.accessor(positions, 3));
    file.primitive()["indices"] = file.accessor(corners, 1);
    return file;
}

json& material(GltfFile& file) { return file.root["materials"][0]; }

json green_glass() {
    return json::parse(R"({"name": "Green", "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
      "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_volume": {"thicknessFactor": 0.2, "attenuationDistance": 0.5,
                                 "attenuationColor": [0.25, 1, 0]}}})");
}

TEST(GltfVolume, AbsorbsWithinClosedMeshes) {
    GltfFile file;
    material(with_tetrahedron(file)) = green_glass();
    const LoadedScene scene = file.read();
    const Shape& shape = scene.description.shapes.at(0);
    ASSERT_NE(shape.inside, nullptr);
    EXPECT_EQ(shape.outside, nullptr);
    EXPECT_NEAR(shape.inside->absorption.x, std::log(4) / 0.5, 1e-9);
    EXPECT_EQ(shape.inside->absorption.y, 0);
    EXPECT_GT(shape.inside->absorption.z, 10);
    EXPECT_LT(shape.inside->absorption.z, 100) << "finite, black as it is";
    EXPECT_TRUE(is_black(shape.inside->scattering));
    EXPECT_STREQ(shape.material->kind(), "dielectric");
    EXPECT_THAT(file.warnings, Not(Contains(HasSubstr("absorb"))));
}

TEST(GltfVolume, OpenMeshesDontAbsorbAndSaySo) {
    GltfFile file;
    material(with_tetrahedron(file, false)) = green_glass();
    file.root["nodes"][0]["name"] = "Shard";
    EXPECT_EQ(file.read().description.shapes.at(0).inside, nullptr);
    EXPECT_THAT(file.warnings,
                Contains(HasSubstr("'Shard' isn't closed: nothing in its glass of the material 'Green'")));
}

TEST(GltfVolume, WithoutThicknessIsAPane) {
    GltfFile file;
    material(with_tetrahedron(file)) = green_glass();
    material(file)["extensions"]["KHR_materials_volume"].erase("thicknessFactor");
    const LoadedScene scene = file.read();
    EXPECT_EQ(scene.description.shapes.at(0).inside, nullptr);
    EXPECT_STREQ(scene.description.shapes.at(0).material->kind(), "mix");
}

TEST(GltfVolume, WithoutDistanceIsClear) {
    GltfFile file;
    material(with_tetrahedron(file)) = green_glass();
    material(file)["extensions"]["KHR_materials_volume"].erase("attenuationDistance");
    const LoadedScene scene = file.read();
    EXPECT_EQ(scene.description.shapes.at(0).inside, nullptr);
    EXPECT_STREQ(scene.description.shapes.at(0).material->kind(), "dielectric");
}

TEST(ClosedMeshes, HaveEveryEdgeBothWays) {
    EXPECT_TRUE(is_closed(make_box({0, 0, 0}, {1, 2, 3}))) << "faces share places, not positions";
    EXPECT_TRUE(is_closed(tessellate({{1, 2, 3}, 2})));
    EXPECT_FALSE(is_closed(make_parallelogram({0, 0, 0}, {1, 0, 0}, {0, 1, 0})));
    TriangleMesh box = make_box({0, 0, 0}, {1, 2, 3});
    std::swap(box.triangles[0][0], box.triangles[0][1]);
    EXPECT_FALSE(is_closed(box)) << "a face looks inward";
    box.triangles.erase(box.triangles.begin());
    EXPECT_FALSE(is_closed(box)) << "a face is missing";
    EXPECT_FALSE(is_closed({}));
    TriangleMesh sphere = tessellate({{1000, 2, 3}, 2});
    for (std::size_t i = 0; i < sphere.positions.size(); ++i)
        sphere.positions[i].x = std::nextafter(sphere.positions[i].x, i % 2 == 0 ? 0.0F : 2000.0F);
    EXPECT_TRUE(is_closed(sphere)) << "seams of files are apart by rounding";
    sphere.triangles.pop_back();
    EXPECT_FALSE(is_closed(sphere));
}

/// A material, and what was said about its file.
struct MaterialOfFile {
    MaterialPtr material;
    std::vector<std::string> warnings;
};

MaterialOfFile material_of(const json& entry) {
    GltfFile file;
    material(with_tetrahedron(file)) = entry;
    MaterialPtr material = file.read().description.shapes.at(0).material;
    return {material, file.warnings};
}

json specular_glossiness(const char* values) {
    json entry;
    entry["extensions"]["KHR_materials_pbrSpecularGlossiness"] = json::parse(values);
    return entry;
}

/// Whether two materials scatter alike, there and back and to the side.
void expect_alike(const MaterialPtr& found, const MaterialPtr& expected) {
    SurfacePoint point;
    point.ng = point.ns = Vec3(0, 0, 1);
    const Vec3 aside = Vec3(1, 0, 1).normalized();
    for (const Vec3& to_eye : {point.ns, aside}) {
        const Rgb f = found->bsdf(point).eval(point.ns, to_eye), e = expected->bsdf(point).eval(point.ns, to_eye);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(f[c], e[c], 1e-3 * e[c]) << c;
    }
}

TEST(GltfSpecularGlossiness, IsPlasticWhereItReflectsLikeGlass) {
    const auto [plastic, warnings] = material_of(specular_glossiness(
        R"({"diffuseFactor": [0.5, 0.2, 0.1, 1], "specularFactor": [0.04, 0.04, 0.04], "glossinessFactor": 0.4})"));
    expect_alike(plastic, material_of(json::parse(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.2, 0.1, 1],
      "metallicFactor": 0, "roughnessFactor": 0.6}})"))
                              .material);
    EXPECT_THAT(warnings, Contains(HasSubstr("KHR_materials_pbrSpecularGlossiness is approximated")));
}

TEST(GltfSpecularGlossiness, IsMetalWhereNothingIsDiffuse) {
    const MaterialPtr gold = material_of(specular_glossiness(R"({"diffuseFactor": [0, 0, 0, 1],
      "specularFactor": [1, 0.7, 0.3], "glossinessFactor": 0.5})"))
                                 .material;
    expect_alike(gold, material_of(json::parse(R"({"pbrMetallicRoughness": {"baseColorFactor": [1, 0.7, 0.3, 1],
      "metallicFactor": 1, "roughnessFactor": 0.5}})"))
                           .material);
}

TEST(GltfSpecularGlossiness, IsADielectricOfHighIndexWhereItReflectsGrey) {
    const double eta = (1 + std::sqrt(0.2)) / (1 - std::sqrt(0.2)); // reflects 20 % along the normal
    json enamel = json::parse(R"({"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.6, 0.1, 1],
      "metallicFactor": 0, "roughnessFactor": 0.2}})");
    enamel["extensions"]["KHR_materials_ior"]["ior"] = eta;
    expect_alike(material_of(specular_glossiness(R"({"diffuseFactor": [0.1, 0.6, 0.1, 1],
      "specularFactor": [0.2, 0.2, 0.2], "glossinessFactor": 0.8})"))
                     .material,
                 material_of(enamel).material);
}

TEST(GltfSpecularGlossiness, HasItsOwnOpacity) {
    GltfFile file;
    material(with_tetrahedron(file)) = specular_glossiness(R"({"diffuseFactor": [1, 1, 1, 0.25]})");
    material(file)["alphaMode"] = "BLEND";
    const LoadedScene scene = file.read();
    ASSERT_NE(scene.description.shapes.at(0).alpha, nullptr);
    EXPECT_EQ(scene.description.shapes.at(0).alpha->value({}), 0.25);
}

/// Radiance of a material that emits 683 cd/m^2, by the program that wrote the file; beside a lamp or alone.
double emitted(const char* generator, bool lamp) {
    GltfFile file;
    material(with_tetrahedron(file)) = json::parse(R"({"emissiveFactor": [1, 1, 1],
      "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 683}}})");
    if (generator != nullptr) file.root["asset"]["generator"] = generator;
    if (lamp) {
        file.root["extensions"] = json::parse(R"({"KHR_lights_punctual": {"lights": [{"type": "point"}]}})");
        file.root["nodes"].push_back(json::parse(R"({"extensions": {"KHR_lights_punctual": {"light": 0}}})"));
        file.root["scenes"][0]["nodes"] = {0, 1};
    }
    return file.read().description.shapes.at(0).emission->radiance.x;
}

TEST(GltfEmission, IsPhotometricBesideLamps) {
    EXPECT_NEAR(emitted("anything", true), 1, 1e-6);
    EXPECT_NEAR(emitted(nullptr, true), 1, 1e-6);
    EXPECT_EQ(emitted("Khronos glTF Blender I/O v3.4.50", true), 683) << "it writes watts, of lamps lumens";
    EXPECT_EQ(emitted("anything", false), 683) << "no other light to compare with";
}

/// Two pixels, white and black.
constexpr const char* kWebp = "data:image/webp;base64,UklGRhgAAABXRUJQVlA4TAsAAAAvAQAAAMX8R/Q/AgA=";
/// Two pixels, red and green, as PNG.
constexpr const char* kPng =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR42mP4z8DwHwiNARAsAzG+Ux4kAAAAAElFTk"
    "SuQmCC";

/// A file whose material emits by its only texture.
void emit_texture(GltfFile& file, const char* texture, const std::vector<const char*>& images) {
    material(with_tetrahedron(file)) = json::parse(R"({"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}})");
    file.root["textures"] = json::array({json::parse(texture)});
    file.root["samplers"] = json::parse(R"([{"magFilter": 9728}])");
    for (const char* image : images) file.root["images"].push_back({{"uri", image}});
}

void expect_pixels(GltfFile& file, const Rgb& left, const Rgb& right) {
    const LoadedScene scene = file.read();
    const ColorTexture picture = scene.description.shapes.at(0).emission->picture;
    SurfacePoint point;
    point.uv = {0.25F, 0.5F};
    EXPECT_EQ(picture->value(point), left);
    point.uv = {0.75F, 0.5F};
    EXPECT_EQ(picture->value(point), right);
}

TEST(GltfTextures, OfWebp) {
    GltfFile file;
    emit_texture(file, R"({"sampler": 0, "extensions": {"EXT_texture_webp": {"source": 0}}})", {kWebp});
    expect_pixels(file, Rgb(1.0), Rgb(0.0));
}

TEST(GltfTextures, FallBackOnTheirPlainSource) {
    GltfFile file;
    emit_texture(file, R"({"sampler": 0, "source": 1, "extensions": {"KHR_texture_basisu": {"source": 0}}})",
                 {"none.ktx2", kPng});
    expect_pixels(file, Rgb(1, 0, 0), Rgb(0, 1, 0));
}

TEST(GltfTextures, WithoutAReadableSourceAreNamed) {
    GltfFile file;
    emit_texture(file, R"({"extensions": {"KHR_texture_basisu": {"source": 0}}})", {"none.ktx2"});
    EXPECT_THAT(file.error(), HasSubstr("found a texture of KHR_texture_basisu without another source, expected PNG"));
}

/// One pixel, (255, 128, 255): as far along u as along the normal.
constexpr const char* kLeaning =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP43/AfAAUAAn8gmLxdAAAAAElFTkSuQmCC";

/// The shading normal by such a map, at a point whose own is z.
Vec3 mapped_normal(double scale) {
    GltfFile file;
    material(with_tetrahedron(file)) =
        json::parse(R"({"pbrMetallicRoughness": {"roughnessFactor": 0}, "normalTexture": {"index": 0}})");
    material(file)["normalTexture"]["scale"] = scale;
    file.root["textures"] = json::parse(R"([{"source": 0}])");
    file.root["images"] = json::array({{{"uri", kLeaning}}});
    const LoadedScene scene = file.read();
    SurfacePoint point;
    point.ng = point.ns = Vec3(0, 0, 1);
    point.tangent = Vec3(1, 0, 0);
    return scene.description.shapes.at(0).material->bsdf(point).shading_normal();
}

TEST(GltfTextures, ScaleOfNormalMaps) {
    EXPECT_NEAR(mapped_normal(1).x / mapped_normal(1).z, 1, 0.01);
    EXPECT_NEAR(mapped_normal(0.5).x / mapped_normal(0.5).z, 0.5, 0.01);
    EXPECT_NEAR(mapped_normal(0).x, 0, 0.01);
}

} // namespace
} // namespace keyhole
