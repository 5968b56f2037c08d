// Colours of the vertices of glTF meshes, which are factors on the base colour and on the opacity.
#include "core/vec.h"
#include "scene/geometry.h"
#include "support/gltf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

using test::GltfFile;
using test::mesh_of;

/// A point of the triangle of the only shape, by the weights of its second and third corner.
SurfacePoint point_of(const LoadedScene& scene, float second, float third) {
    SurfacePoint point = triangle_point(mesh_of(scene), 0, second, third);
    point.shape = 0;
    return point;
}

Rgb diffuse_at(const LoadedScene& scene, float second, float third) {
    const SurfacePoint point = point_of(scene, second, third);
    return scene.description.shapes.at(0).material->bsdf(point).diffuse_reflectance(point.ns);
}

/// A matte triangle. Its base colour is (1, 0.5, 1), and its opacity 0.5.
void make_matte(GltfFile& file) {
    file.plain_triangle();
    file.root["materials"][0] = nlohmann::json::parse(R"({"alphaMode": "BLEND",
      "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 1, 0.5], "metallicFactor": 0},
      "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})");
}

void expect_colors(GltfFile& file, bool opacities) {
    GltfFile white;
    make_matte(white);
    const LoadedScene plain = white.read(), scene = file.read();
    const Rgb all = diffuse_at(plain, 0.25F, 0.25F);
    const std::array<std::pair<Vec2, Rgb>, 4> places{
        {{{0, 0}, {1, 0, 0}}, {{1, 0}, {0, 1, 0}}, {{0, 1}, {0, 0, 0.4}}, {{0.5F, 0.25F}, {0.25, 0.5, 0.1}}}};
    for (const auto& [at, factor] : places) {
        const Rgb found = diffuse_at(scene, at.x, at.y);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], all[c] * factor[c], 2e-3 * all[c]) << at << c;
    }
    const FloatTexture alpha = scene.description.shapes.at(0).alpha;
    ASSERT_NE(alpha, nullptr);
    EXPECT_NEAR(alpha->value(point_of(scene, 0, 0)), 0.5, 1e-6);
    EXPECT_NEAR(alpha->value(point_of(scene, 0.5F, 0)), opacities ? 0.3 : 0.5, 2e-3) << "of the second corner 0.2";
}

TEST(GltfVertexColors, MultiplyTheBaseColour) {
    GltfFile floats;
    make_matte(floats);
    floats.attribute("COLOR_0", floats.accessor<float>({1, 0, 0, 1, 0, 1, 0, 0.2F, 0, 0, 0.4F, 1}, 4));
    expect_colors(floats, true);
}

TEST(GltfVertexColors, AreOpaqueWithoutAlpha) {
    GltfFile floats;
    make_matte(floats);
    floats.attribute("COLOR_0", floats.accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.4F}, 3));
    expect_colors(floats, false);
}

TEST(GltfVertexColors, OfNormalisedIntegers) {
    GltfFile words;
    make_matte(words);
    words.attribute("COLOR_0",
                    words.accessor<std::uint16_t>({65535, 0, 0, 0, 0, 65535, 0, 0, 0, 0, 26214, 0}, 3, true, 8));
    expect_colors(words, false);
    GltfFile bytes;
    make_matte(bytes);
    bytes.attribute("COLOR_0", bytes.accessor<std::uint8_t>({255, 0, 0, 255, 0, 255, 0, 51, 0, 0, 102, 255}, 4, true));
    expect_colors(bytes, true);
}

TEST(GltfVertexColors, FollowTheirPlacesInMirroredNodes) {
    GltfFile file;
    make_matte(file);
    file.root["nodes"][0]["scale"] = {-1, 1, 1};
    file.attribute("COLOR_0", file.accessor<float>({0.25F, 0.25F, 0.25F, 1, 1, 1, 0.5F, 0.5F, 0.5F}, 3));
    const LoadedScene scene = file.read();
    const TriangleMesh& mesh = mesh_of(scene);
    for (int corner = 0; corner < 3; ++corner) {
        const Vec3 p = mesh.positions[mesh.triangles[0][corner]];
        const double expected = p.x < -0.5F ? 1 : p.y > 0.5F ? 0.5 : 0.25;
        const double white = diffuse_at(scene, corner == 1, corner == 2).x * kPi;
        EXPECT_NEAR(white / expected, 1, 0.1) << p;
    }
}

TEST(GltfVertexColors, WhiteOnesAreNone) {
    GltfFile file;
    file.plain_triangle();
    file.attribute("COLOR_0", file.accessor<float>(std::vector<float>(12, 1), 4));
    EXPECT_FALSE(file.read().description.shapes.at(0).material->reads_parametrisation());
}

} // namespace
} // namespace keyhole
