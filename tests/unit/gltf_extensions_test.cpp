// Extensions of glTF beside those of materials: instances, and those that files require.
#include "scene/geometry.h"
#include "scene/load/load_mesh.h"
#include "support/gltf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

using nlohmann::json;
using test::GltfFile;
using test::mesh_of;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class GltfInstances : public testing::Test {
  protected:
    GltfInstances() {
        file_.plain_triangle();
        file_.root["extensionsRequired"] = file_.root["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    }
    void instances(const json& attributes) {
        file_.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", attributes}};
    }
    static void expect_corners(const TriangleMesh& mesh, const std::vector<Vec3>& corners) {
        ASSERT_EQ(mesh.positions.size(), corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i)
            EXPECT_LT((mesh.positions[i] - corners[i]).length(), 1e-4) << i << ": " << mesh.positions[i];
    }

    GltfFile file_;
};

TEST_F(GltfInstances, StandWhereTheirAttributesSay) {
    // The second is turned by a quarter about z, and twice as large.
    const auto translations = file_.accessor<float>({0, 0, 5, 1, 2, 3}, 3),
               scales = file_.accessor<float>({1, 1, 1, 2, 2, 2}, 3);
    const auto rotations = file_.accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 23170, 23170}, 4, true);
    instances({{"TRANSLATION", translations}, {"ROTATION", rotations}, {"SCALE", scales}, {"_ID", 77}});
    file_.root["nodes"][0]["translation"] = {100, 0, 0};
    file_.root["nodes"][0]["name"] = "Fern";
    const LoadedScene scene = file_.read();
    ASSERT_EQ(scene.description.shapes.size(), 2u);
    expect_corners(mesh_of(scene, 0), {{100, 0, 5}, {101, 0, 5}, {100, 1, 5}});
    expect_corners(mesh_of(scene, 1), {{101, 2, 3}, {101, 4, 3}, {99, 2, 3}});
    EXPECT_EQ(scene.description.shapes[1].name, "Fern");
    EXPECT_EQ(import_mesh(file_.write()).triangles.size(), 2u);
}

TEST_F(GltfInstances, KeepTheChildrenOfTheirNode) {
    instances({{"TRANSLATION", file_.accessor<float>({0, 0, 1, 0, 0, 2, 0, 0, 3}, 3)}});
    file_.root["nodes"][0]["children"] = {1};
    file_.root["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 9}}});
    EXPECT_EQ(file_.read().description.shapes.size(), 4u) << "children aren't instances";
}

TEST_F(GltfInstances, BrokenOnesAreErrors) {
    const auto two = file_.accessor<float>({0, 0, 1, 0, 0, 2}, 3), one = file_.accessor<float>({0, 0, 1}, 3);
    instances({{"TRANSLATION", two}, {"SCALE", one}});
    EXPECT_THAT(file_.error(), HasSubstr("found 1 of SCALE of instances, expected 2"));
    instances({{"ROTATION", one}});
    EXPECT_THAT(file_.error(), HasSubstr("found 3 numbers a row of ROTATION of instances, expected 4"));
    instances({{"TRANSLATION", 99}});
    EXPECT_THAT(file_.error(), HasSubstr("no entry 99 of 'accessors'"));
}

/// The error of a file with an extension, or its warnings.
std::string said_of(const std::string& name, bool required) {
    GltfFile file;
    file.plain_triangle();
    file.root["extensionsUsed"] = {name};
    if (required) file.root["extensionsRequired"] = {name};
    std::string said = file.error();
    for (const std::string& warning : file.warnings) said += "\n" + warning;
    return said;
}

TEST(GltfExtensions, RequiredAndUnknownIsAnError) {
    EXPECT_THAT(said_of("ACME_walls", true), HasSubstr("scene.gltf: found the extension ACME_walls, which the file "
                                                       "requires, expected"));
    EXPECT_THAT(said_of("KHR_texture_basisu", true), HasSubstr("export it with PNG"));
    GltfFile file;
    file.plain_triangle();
    file.root["extensionsRequired"] = {"ACME_walls"};
    EXPECT_THROW(import_mesh(file.write()), InputError);
}

TEST(GltfExtensions, UsedAndUnknownIsAWarning) {
    EXPECT_THAT(said_of("ACME_walls", false), HasSubstr("no error"));
    EXPECT_THAT(said_of("ACME_walls", false), HasSubstr("the extension ACME_walls is left out"));
    EXPECT_THAT(said_of("KHR_xmp_json_ld", false), Not(HasSubstr("KHR_xmp"))) << "no light comes of it";
}

TEST(GltfExtensions, KnownOnesMayBeRequired) {
    for (const char* name : {"KHR_texture_transform", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
                             "KHR_lights_punctual", "KHR_materials_ior", "EXT_texture_webp"}) {
        EXPECT_THAT(said_of(name, true), HasSubstr("no error")) << name;
        EXPECT_THAT(said_of(name, true), Not(HasSubstr("the extension"))) << name;
    }
    EXPECT_THAT(said_of("KHR_materials_unlit", true), HasSubstr("no error")) << "materials say what they leave out";
}

TEST(GltfExtensions, CompressedViewsAreErrorsWithoutAFallback) {
    GltfFile file;
    file.plain_triangle();
    file.root["extensionsUsed"] = {"EXT_meshopt_compression"};
    file.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
        {"buffer", 0}, {"byteLength", 20}, {"byteStride", 12}, {"mode", "ATTRIBUTES"}, {"count", 3}};
    EXPECT_EQ(file.error(), "no error") << "the buffer has the plain bytes";
    file.root["buffers"] = json::parse(
        R"([{"byteLength": 36}, {"byteLength": 36, "extensions": {"EXT_meshopt_compression": {"fallback": true}}}])");
    file.root["bufferViews"][0]["buffer"] = 1;
    EXPECT_THAT(file.error(), HasSubstr("found EXT_meshopt_compression, expected plain buffers: export it without"));
}

TEST(GltfExtensions, ValuesNestedTooDeepAreErrors) {
    constexpr std::size_t kDeep = 200'000;
    GltfFile file;
    const std::string text =
        R"({"asset": {"version": "2.0"}, "extras": )" + std::string(kDeep, '[') + std::string(kDeep, ']') + "}";
    const std::string path = file.folder().write("deep.gltf", text);
    for (const bool scene : {true, false}) {
        std::string error = "no error";
        try {
            if (scene)
                load(path, {}, nullptr);
            else
                import_mesh(path);
        } catch (const InputError& e) {
            error = e.what();
        }
        EXPECT_THAT(error, HasSubstr("deep.gltf: found values nested more than 512 deep"));
    }
}

TEST(GltfExtensions, MorphTargetsAreLeftOutAndSaySo) {
    GltfFile file;
    file.plain_triangle();
    file.primitive()["targets"] = json::array({{{"POSITION", file.accessor<float>(std::vector<float>(9, 1), 3)}}});
    EXPECT_EQ(mesh_of(file.read()).positions.at(0), Vec3(0, 0, 0));
    EXPECT_THAT(file.warnings, Not(Contains(HasSubstr("targets")))) << "as they are, targets change nothing";
    file.root["meshes"][0]["weights"] = {0.5};
    EXPECT_EQ(mesh_of(file.read()).positions.at(0), Vec3(0, 0, 0));
    EXPECT_THAT(file.warnings, Contains(HasSubstr("morph targets are left out")));
    file.root["meshes"][0].erase("weights");
    file.root["nodes"][0]["weights"] = {0.5};
    file.read();
    EXPECT_THAT(file.warnings, Contains(HasSubstr("morph targets are left out")));
}

/// A triangle with the legs (1, 0, 0) and (0, 1, 0), and texture coordinates, packed by Draco's own encoder.
const std::vector<std::uint8_t> kDraco{
    68,  82,  65, 67, 79,  2,   2,   1,  1,  0, 0, 0, 3, 1,   1,  1,  0,  0, 1,  7,   255, 1,  17, 1, 1, 0, 2,
    255, 0,   0,  0,  0,   0,   1,   0,  9,  3, 0, 0, 2, 1,   3,  9,  2,  0, 1,  2,   1,   1,  1,  0, 3, 3, 85,
    21,  173, 42, 3,  4,   112, 129, 49, 16, 0, 0, 0, 0, 255, 63, 0,  0,  0, 0,  0,   0,   0,  0,  0, 0, 0, 0,
    0,   0,   0,  0,  128, 63,  14,  5,  1,  1, 0, 3, 3, 173, 42, 85, 21, 3, 81, 101, 129, 25, 1,  0, 0, 0, 255,
    1,   17,  0,  0,  0,   0,   255, 3,  0,  0, 0, 0, 0, 0,   0,  0,  0,  0, 0,  0,   128, 63, 10};

/// A file whose only triangle is packed.
void pack_triangle(GltfFile& file) {
    file.root["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    file.root["accessors"] = json::parse(R"([{"componentType": 5126, "count": 3, "type": "VEC3"},
      {"componentType": 5126, "count": 3, "type": "VEC2"}, {"componentType": 5123, "count": 3, "type": "SCALAR"}])");
    file.attribute("POSITION", 0);
    file.attribute("TEXCOORD_0", 1);
    file.primitive()["indices"] = 2;
    file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", file.view(kDraco)}, {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}};
}

TEST(GltfExtensions, DracoIsUnpackedByAssimp) {
    GltfFile file;
    pack_triangle(file);
    file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    if (const std::string error = file.error(); error != "no error") {
        EXPECT_THAT(error, HasSubstr("KHR_draco_mesh_compression")) << "an Assimp without it says so";
        GTEST_SKIP() << error;
    }
    const LoadedScene scene = file.read();
    EXPECT_NEAR(triangle_area(mesh_of(scene), 0), 0.5, 1e-3);
}

TEST(GltfExtensions, PlainNumbersBesideDracoAreRead) {
    GltfFile file;
    pack_triangle(file);
    file.root["bufferViews"][0]["byteLength"] = 20; // broken
    const auto positions = file.accessor<std::int16_t>({0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 0}, 3, false, 8);
    file.attribute("POSITION", positions);
    file.attribute("TEXCOORD_0", file.accessor<float>({0, 0, 1, 0, 0, 1}, 2));
    file.primitive()["indices"] = file.accessor<std::uint16_t>({0, 1, 2}, 1);
    EXPECT_NEAR(triangle_area(mesh_of(file.read()), 0), 6, 1e-6);
}

TEST(GltfExtensions, IntegersInDracoAreErrors) {
    GltfFile file;
    pack_triangle(file);
    file.root["accessors"][0]["componentType"] = 5122;
    EXPECT_THAT(file.error(), HasSubstr("found integers packed by KHR_draco_mesh_compression, expected floats"));
}

} // namespace
} // namespace keyhole
