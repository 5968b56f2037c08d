// What glTF files lose is said, and what is wrong with them by its place in the file and in its units.
#include "scene/geometry.h"
#include "scene/load/load_mesh.h"
#include "support/gltf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace keyhole {
namespace {

using nlohmann::json;
using test::GltfFile;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A square of two triangles, on a mesh and a node with names, and beside it a triangle without one.
class GltfErrors : public testing::Test {
  protected:
    GltfErrors() {
        file_.attribute("POSITION", file_.accessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3));
        const std::size_t positions = file_.accessor<float>({5, 0, 0, 6, 0, 0, 5, 1, 0}, 3);
        file_.root["meshes"][0]["name"] = "Floor";
        file_.root["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
        file_.root["nodes"][0]["name"] = "Hall";
        file_.root["nodes"].push_back({{"mesh", 1}});
        file_.root["scenes"][0]["nodes"] = {0, 1};
        file_.root["materials"][0]["name"] = "Oak";
        indices({0, 1, 2, 0, 2, 3});
    }
    void indices(const std::vector<std::uint16_t>& corners) {
        file_.primitive()["indices"] = file_.accessor(corners, 1);
    }
    void light(const json& what) {
        file_.root["extensions"]["KHR_lights_punctual"]["lights"] = json::array({what});
        file_.root["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    }
    std::size_t triangles() {
        std::size_t sum = 0;
        for (const Shape& shape : file_.read().description.shapes) sum += triangle_count(shape);
        return sum;
    }

    GltfFile file_;
};

TEST_F(GltfErrors, WholeFilesHaveNothingToSay) {
    EXPECT_EQ(triangles(), 3u);
    EXPECT_THAT(file_.warnings, Not(Contains(HasSubstr("left out"))));
}

TEST_F(GltfErrors, PointsAndLinesAreLeftOutAndSaySo) {
    for (const int mode : {0, 1, 2, 3}) {
        file_.primitive()["mode"] = mode;
        EXPECT_EQ(triangles(), 1u);
        EXPECT_THAT(file_.warnings, Contains(HasSubstr(mode == 0 ? "points are left out, such as those of the mesh 0 "
                                                                   "'Floor'"
                                                                 : "lines are left out, such as those of the mesh 0 "
                                                                   "'Floor'")));
    }
    for (const int mode : {4, 5, 6}) {
        file_.primitive()["mode"] = mode;
        file_.read();
        EXPECT_THAT(file_.warnings, Not(Contains(HasSubstr("left out")))) << mode;
    }
    file_.primitive()["mode"] = 7;
    EXPECT_THAT(file_.error(), HasSubstr("scene.gltf: the mesh 0 'Floor': found the mode 7, expected 0 to 6"));
}

TEST_F(GltfErrors, WhatNoSceneHoldsIsNotMissed) {
    file_.primitive()["mode"] = 1;
    file_.root["scenes"][0]["nodes"] = {1};
    file_.read();
    EXPECT_THAT(file_.warnings, Not(Contains(HasSubstr("left out"))));
}

TEST_F(GltfErrors, CornersOfNoWholeTriangleAreLeftOutAndSaySo) {
    indices({0, 1, 2, 0, 2});
    EXPECT_EQ(triangles(), 2u);
    EXPECT_THAT(file_.warnings,
                Contains(HasSubstr("corners of no whole triangle are left out, such as 2 of 5 of the mesh 0 'Floor'")));
    indices({0, 1, 2});
    file_.root["meshes"][1]["primitives"][0]["attributes"]["POSITION"] = 0; // four, without indices
    EXPECT_EQ(triangles(), 2u);
    EXPECT_THAT(file_.warnings, Contains(HasSubstr("such as 1 of 4 of the mesh 1")));
}

TEST_F(GltfErrors, IndicesOutOfRangeAreRefusedAndSaid) {
    for (const std::uint16_t index : {std::uint16_t{4}, std::uint16_t{99}, std::uint16_t{65280}}) {
        indices({0, 1, 2, 0, 2, index});
        const std::string expected = "scene.gltf: the mesh 0 'Floor': found the index " + std::to_string(index) +
                                     ", expected one of 4 positions";
        EXPECT_THAT(file_.error(), HasSubstr(expected));
        EXPECT_THROW(import_mesh(file_.write()), InputError);
    }
    file_.primitive()["indices"] = file_.accessor<std::int16_t>({0, 1, -1}, 1);
    EXPECT_THAT(file_.error(), HasSubstr("the mesh 0 'Floor': found indices of the component type 5122, expected"));
    file_.primitive()["indices"] = file_.accessor<std::uint16_t>({0, 1, 2, 0, 0, 0}, 3);
    EXPECT_THAT(file_.error(), HasSubstr("the mesh 0 'Floor': found indices of the type 'VEC3', expected SCALAR"));
}

TEST_F(GltfErrors, LargeIndicesCountOneByOne) {
    file_.root["accessors"][0].erase("bufferView"); // all zero
    file_.root["accessors"][0]["count"] = (1U << 24) + 2;
    file_.primitive()["indices"] = file_.accessor<std::uint32_t>({0, 1, (1U << 24) + 3}, 1);
    EXPECT_THAT(file_.error(), HasSubstr("found the index 16777219, expected one of 16777218 positions"));
}

TEST_F(GltfErrors, UnknownAlphaModesAreRefused) {
    file_.root["materials"][0]["alphaMode"] = "BLENT";
    EXPECT_THAT(file_.error(), HasSubstr("scene.gltf: the material 0 'Oak': found the alphaMode 'BLENT', expected one "
                                         "of OPAQUE, MASK, BLEND; did you mean 'BLEND'?"));
}

TEST_F(GltfErrors, FactorsHaveTheirLength) {
    json& material = file_.root["materials"][0];
    material["pbrMetallicRoughness"]["baseColorFactor"] = {.5, .5, .5};
    EXPECT_THAT(file_.error(), HasSubstr("the material 0 'Oak': found 3 numbers in 'baseColorFactor', expected 4"));
    material["pbrMetallicRoughness"]["baseColorFactor"] = {.5, .5, .5, 1};
    material["emissiveFactor"] = {1, 1, 1, 1};
    EXPECT_THAT(file_.error(), HasSubstr("the material 0 'Oak': found 4 numbers in 'emissiveFactor', expected 3"));
    material["emissiveFactor"] = {1, 1, "1"};
    EXPECT_THAT(file_.error(),
                HasSubstr("the material 0 'Oak': found a string in 'emissiveFactor', expected numbers alone"));
}

TEST_F(GltfErrors, OfLightsAreInUnitsOfTheFile) {
    light({{"type", "spot"}, {"name", "Lamp"}, {"spot", {{"innerConeAngle", .9}, {"outerConeAngle", .5}}}});
    EXPECT_THAT(
        file_.error(),
        HasSubstr("scene.gltf: the light 0 'Lamp': found 'innerConeAngle' 0.9 and 'outerConeAngle' 0.5, expected 0 "
                  "<= inner <= outer <= pi/2, and some width"));
    light({{"type", "spot"}, {"spot", {{"outerConeAngle", 3.2}}}});
    EXPECT_THAT(file_.error(), HasSubstr("the light 0: found 'innerConeAngle' 0 and 'outerConeAngle' 3.2, expected"));
    light({{"type", "spot"}, {"spot", {{"outerConeAngle", static_cast<float>(kPi / 2)}}}});
    EXPECT_EQ(file_.error(), "no error") << "a half space as a float";
    light({{"type", "point"}, {"name", "Bulb"}, {"intensity", "10"}});
    EXPECT_THAT(file_.error(), HasSubstr("the light 0 'Bulb': found a string in 'intensity', expected a number"));
    light({{"type", "point"}, {"name", "Bulb"}, {"intensity", -10}});
    EXPECT_THAT(file_.error(), HasSubstr("the light 0 'Bulb': found -10 as an amount of light"));
    light({{"name", "Bulb"}});
    EXPECT_THAT(file_.error(), HasSubstr("the light 0 'Bulb': found no 'type', expected one"));
}

TEST_F(GltfErrors, OfNodesNameThem) {
    json& node = file_.root["nodes"][0];
    node["scale"] = {1, 1};
    EXPECT_THAT(file_.error(), HasSubstr("scene.gltf: the node 0 'Hall': found 2 numbers in 'scale', expected 3"));
    node["scale"] = "large";
    EXPECT_THAT(file_.error(), HasSubstr("the node 0 'Hall': found a string in 'scale', expected 3 numbers"));
    node.erase("scale");
    node["mesh"] = "Floor";
    EXPECT_THAT(file_.error(), HasSubstr("the node 0 'Hall': found a string in 'mesh', expected a number"));
}

TEST_F(GltfErrors, OfMissingBuffersNameTheFileThatRefersToThem) {
    const std::string path = file_.write();
    std::filesystem::remove(file_.folder().path("numbers.bin"));
    std::string said;
    try {
        load(path, {});
    } catch (const InputError& e) {
        said = e.what();
    }
    EXPECT_THAT(said, HasSubstr("scene.gltf: "));
    EXPECT_THAT(said, HasSubstr("numbers.bin: found no such file"));
}

TEST_F(GltfErrors, OfJsonAreWordsWithTheirPlace) {
    file_.root["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = "0.5";
    EXPECT_THAT(file_.error(),
                HasSubstr("the material 0 'Oak': found a string in 'roughnessFactor', expected a number"));
    file_.root["materials"][0]["pbrMetallicRoughness"] = json::object();
    file_.primitive()["attributes"]["POSITION"] = "0";
    EXPECT_THAT(file_.error(), HasSubstr("the mesh 0 'Floor': "));
    EXPECT_THAT(file_.error(), Not(HasSubstr("json.exception")));
    file_.primitive()["attributes"]["POSITION"] = 0;
    file_.root["accessors"][0].erase("count");
    EXPECT_THAT(file_.error(), HasSubstr("the mesh 0 'Floor': found no 'count', expected one"));
}

TEST_F(GltfErrors, NodesWithoutNamesHaveThoseOfTheirMeshes) {
    file_.root["nodes"][0].erase("name");
    const LoadedScene scene = file_.read();
    EXPECT_EQ(scene.description.shapes.at(0).name, "Floor");
    EXPECT_EQ(scene.description.shapes.at(1).name, "node 1");
}

} // namespace
} // namespace keyhole
