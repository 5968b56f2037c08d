// Attributes of glTF meshes in all the types of number that the format and KHR_mesh_quantization have.
#include "scene/load/load_mesh.h"
#include "support/gltf_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace keyhole {
namespace {

using test::GltfFile;
using test::mesh_of;
using testing::HasSubstr;

void expect_near(const Vec3& found, const Vec3& expected) {
    EXPECT_LT((found - expected).length(), 1e-5) << found << " for " << expected;
}

void expect_uvs(const TriangleMesh& mesh, const std::vector<Vec2>& expected) {
    ASSERT_EQ(mesh.uvs.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_NEAR(mesh.uvs[i].x, expected[i].x, 1e-6) << i;
        EXPECT_NEAR(mesh.uvs[i].y, 1 - expected[i].y, 1e-6) << i << ", counted up from the last row";
    }
}

TEST(GltfAccessors, NormalisedTextureCoordinatesAreShares) {
    for (const bool packed : {false, true}) {
        GltfFile words;
        words.plain_triangle();
        words.attribute("TEXCOORD_0", words.accessor<std::uint16_t>({0, 65535, 13107, 0, 65535, 26214}, 2, true));
        expect_uvs(mesh_of(words.read(packed)), {{0, 1}, {0.2F, 0}, {1, 0.4F}});
        GltfFile bytes;
        bytes.plain_triangle();
        bytes.attribute("TEXCOORD_0",
                        bytes.accessor<std::uint8_t>({0, 255, 9, 9, 51, 0, 9, 9, 255, 102, 9, 9}, 2, true, 4));
        expect_uvs(mesh_of(bytes.read(packed)), {{0, 1}, {0.2F, 0}, {1, 0.4F}});
    }
}

TEST(GltfAccessors, QuantisedPositionsAndNormals) {
    GltfFile file;
    file.root["extensionsRequired"] = file.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.root["nodes"][0]["scale"] = {0.001, 0.001, 0.001};
    file.root["nodes"][0]["translation"] = {1, 2, 3};
    file.attribute("POSITION",
                   file.accessor<std::int16_t>({-1000, 0, 0, 7, 3000, 0, 500, 7, 0, 30000, 0, 7}, 3, false, 8));
    file.attribute("NORMAL", file.accessor<std::int8_t>({0, 0, 127, 9, 127, 0, 0, 9, 0, -128, 0, 9}, 3, true, 4));
    file.attribute("TANGENT", file.accessor<std::int8_t>(std::vector<std::int8_t>(12, 127), 4, true));
    file.attribute("TEXCOORD_0", file.accessor<std::uint16_t>({0, 0, 3, 0, 4095, 2}, 2));
    const LoadedScene scene = file.read();
    const TriangleMesh& mesh = mesh_of(scene);
    ASSERT_EQ(mesh.positions.size(), 3u);
    expect_near(mesh.positions[0], {0, 2, 3});
    expect_near(mesh.positions[1], {4, 2, 3.5F});
    expect_near(mesh.positions[2], {1, 32, 3});
    expect_near(mesh.normals.at(0), {0, 0, 1});
    expect_near(mesh.normals.at(1), {1, 0, 0});
    expect_near(mesh.normals.at(2), {0, -1, 0});
    expect_uvs(mesh, {{0, 0}, {3, 0}, {4095, 2}});
    EXPECT_THAT(file.warnings, testing::Not(testing::Contains(HasSubstr("quantization"))));
}

TEST(GltfAccessors, NormalisedPositionsOfBytes) {
    GltfFile file;
    file.attribute("POSITION", file.accessor<std::int8_t>({-127, -128, 0, 9, 127, 0, 0, 9, 0, 127, 0, 9}, 3, true, 4));
    const LoadedScene scene = file.read();
    expect_near(mesh_of(scene).positions.at(0), {-1, -1, 0}); // what lies below -1 is -1
    expect_near(mesh_of(scene).positions.at(1), {1, 0, 0});
    expect_near(mesh_of(scene).positions.at(2), {0, 1, 0});
}

TEST(GltfAccessors, SparseIntegers) {
    GltfFile file;
    const std::size_t positions = file.accessor<std::uint16_t>({0, 0, 0, 9, 1, 0, 0, 9, 0, 1, 0, 9}, 3, false, 8);
    const std::size_t places = file.view<std::uint8_t>({1, 2}), values = file.view<std::uint16_t>({5, 0, 0, 0, 7, 0});
    file.root["accessors"][positions]["sparse"] = {{"count", 2},
                                                   {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                                                   {"values", {{"bufferView", values}}}};
    file.attribute("POSITION", positions);
    const LoadedScene scene = file.read();
    expect_near(mesh_of(scene).positions.at(1), {5, 0, 0});
    expect_near(mesh_of(scene).positions.at(2), {0, 7, 0});
}

/// Positions and normals by turns, of which two positions are replaced.
TEST(GltfAccessors, SparseFloatsBetweenOthers) {
    for (const bool packed : {false, true}) {
        GltfFile file;
        const std::size_t positions =
            file.accessor<float>({0, 0, 0, 8, 8, 8, 1, 0, 0, 8, 8, 8, 0, 1, 0, 8, 8, 8}, 3, false, 24);
        const std::size_t places = file.view<std::uint16_t>({1, 2}), values = file.view<float>({5, 0, 0, 0, 7, 0});
        file.root["accessors"][positions]["sparse"] = {{"count", 2},
                                                       {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                                                       {"values", {{"bufferView", values}}}};
        file.attribute("POSITION", positions);
        const LoadedScene scene = file.read(packed);
        ASSERT_EQ(mesh_of(scene).positions.size(), 3u);
        expect_near(mesh_of(scene).positions[0], {0, 0, 0});
        expect_near(mesh_of(scene).positions[1], {5, 0, 0});
        expect_near(mesh_of(scene).positions[2], {0, 7, 0});
    }
}

/// What the format doesn't allow.
TEST(GltfAccessors, SparseIndicesWithGapsAreErrors) {
    GltfFile file;
    file.plain_triangle();
    const std::size_t indices = file.accessor<std::uint16_t>({0, 9, 1, 9, 2, 9}, 1, false, 4);
    const std::size_t places = file.view<std::uint8_t>({0}), values = file.view<std::uint16_t>({0});
    file.root["accessors"][indices]["sparse"] = {{"count", 1},
                                                 {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                                                 {"values", {{"bufferView", values}}}};
    file.primitive()["indices"] = indices;
    EXPECT_THAT(file.error(), HasSubstr("found 'byteStride' of the view of accessor 1, expected none"));
}

TEST(GltfAccessors, MeshesOfOtherScenesToo) {
    GltfFile file;
    file.attribute("POSITION", file.accessor<std::int16_t>({0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0}, 3, false, 8));
    const TriangleMesh mesh = import_mesh(file.write());
    expect_near(mesh.positions.at(1), {3, 0, 0});
    expect_near(mesh.positions.at(2), {0, 4, 0});
}

TEST(GltfAccessors, NumbersThatAreNoneNameTheirMesh) {
    GltfFile file;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    file.attribute("POSITION", file.accessor<float>({0, 0, 0, 1, 0, 0, 0, nan, 0}, 3));
    file.root["nodes"][0]["name"] = "Vase";
    EXPECT_THAT(file.error(), HasSubstr("scene.gltf: the mesh 'Vase': found the coordinate nan"));
}

TEST(GltfAccessors, BrokenOnesAreErrors) {
    const auto error_with = [](const char* pointer, const nlohmann::json& value) {
        GltfFile file;
        file.attribute("POSITION", file.accessor<std::int16_t>({0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0}, 3, false, 8));
        file.root[nlohmann::json::json_pointer(pointer)] = value;
        return file.error();
    };
    EXPECT_EQ(error_with("/asset/generator", "none"), "no error");
    EXPECT_THAT(error_with("/accessors/0/count", 4), HasSubstr("accessor 0 beyond its view of 24 bytes"));
    EXPECT_THAT(error_with("/accessors/0/count", 1ULL << 60), HasSubstr("found accessor 0 with"));
    EXPECT_THAT(error_with("/accessors/0/byteOffset", -2), HasSubstr("accessor 0 beyond"));
    EXPECT_THAT(error_with("/accessors/0/componentType", 99), HasSubstr("found the component type 99"));
    EXPECT_THAT(error_with("/accessors/0/type", "MAT2"), HasSubstr("found the type 'MAT2'"));
    EXPECT_THAT(error_with("/accessors/0/bufferView", 7), HasSubstr("no entry 7 of 'bufferViews'"));
    EXPECT_THAT(error_with("/bufferViews/0/byteLength", 7000), HasSubstr("beyond its buffer"));
    EXPECT_THAT(error_with("/accessors/0/sparse", nlohmann::json::parse(R"({"count": 1,
      "indices": {"bufferView": 0, "componentType": 5123, "byteOffset": 18}, "values": {"bufferView": 0}})")),
                HasSubstr("found entry 4 replaced, expected one of 3"));
}

} // namespace
} // namespace keyhole
