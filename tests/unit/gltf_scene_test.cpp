// glTF files as scenes: lights, cameras and materials by the numbers of the format, and broken files.
#include "core/error.h"
#include "scene/load/load.h"
#include "scene/scene.h"
#include "support/scratch_directory.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <numbers>

namespace keyhole {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A right angle at the origin whose legs are 1 m long along x and y, as base64 of three positions and three indices.
constexpr const char* kTriangle = R"("buffers": [{"byteLength": 42, "uri":
  "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                 "max": [1, 1, 0]}, {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}])";

class GltfScene : public testing::Test {
  protected:
    /// @param rest beside the mesh: nodes, materials, lights, cameras
    LoadedScene read(const std::string& rest) {
        const std::string path = folder_.path("scene.gltf");
        std::ofstream(path) << fmt::format(R"({{"asset": {{"version": "2.0"}}, "scene": 0, {}, {}}})", kTriangle, rest);
        warnings_.clear();
        return load(path, {}, &warnings_);
    }
    std::string error_of(const std::string& rest) {
        try {
            read(rest);
        } catch (const InputError& e) {
            return e.what();
        }
        return "no error";
    }

    ScratchDirectory folder_;
    std::vector<std::string> warnings_;
};

constexpr const char* kPlain = R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "materials": [{}])";

TEST_F(GltfScene, WithoutCameraOrLightHasBothAndSaysSo) {
    const LoadedScene scene = read(kPlain);
    ASSERT_EQ(scene.description.shapes.size(), 1u);
    ASSERT_EQ(scene.description.emitters.size(), 1u);
    EXPECT_THAT(warnings_, Contains(HasSubstr("found no light")));
    EXPECT_THAT(warnings_, Contains(HasSubstr("found no camera")));
    const Vec3 to_middle = Vec3(0.5F, 0.5F, 0) - scene.description.camera.origin;
    EXPECT_GT(to_middle.normalized().dot(scene.description.camera.forward), 0.9999);
}

TEST_F(GltfScene, LightsAreInWattsByLumens) {
    const LoadedScene scene = read(R"("materials": [{}], "scenes": [{"nodes": [0, 1]}],
      "nodes": [{"mesh": 0}, {"translation": [1, 2, 3], "children": [2]},
                {"scale": [2, 2, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 1366, "color": [1, 1, 1]}]}})");
    ASSERT_EQ(scene.description.emitters.size(), 1u);
    const Emitter& lamp = *scene.description.emitters.front();
    EXPECT_NEAR(lamp.power(), 2 * 4 * std::numbers::pi, 1e-5);
    ASSERT_TRUE(lamp.bounds());
    EXPECT_LT((lamp.bounds()->lower - Vec3(1, 2, 3)).length(), 1e-6);
    EXPECT_THAT(warnings_, testing::Not(Contains(HasSubstr("found no light"))));
}

TEST_F(GltfScene, LightsThatAreNoneAreErrorsInTheirUnits) {
    EXPECT_THAT(error_of(R"("materials": [{}], "scenes": [{"nodes": [0, 1]}],
      "nodes": [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": -5}]}})"),
                HasSubstr("found -5 as an amount of light"));
}

/// By the square of the share of the way between the cosines of the cones, as the extension recommends.
TEST_F(GltfScene, SpotsFadeBySquares) {
    const LoadedScene scene = read(R"("materials": [{}], "scenes": [{"nodes": [0, 1]}],
      "nodes": [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 683,
        "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.6}}]}})");
    const Emitter& lamp = *scene.description.emitters.at(0);
    const double inner = std::cos(0.2), outer = std::cos(0.6), cosine = (inner + outer) / 2;
    const Vec3 w(static_cast<float>(std::sqrt(1 - cosine * cosine)), 0, static_cast<float>(-cosine));
    EXPECT_NEAR(luminance(lamp.radiance({}, w)), 0.25, 1e-5);
    EXPECT_NEAR(lamp.power(), 2 * std::numbers::pi * (1 - inner + (inner - outer) / 3), 1e-6);
}

TEST_F(GltfScene, RotationsOfLengthZeroAreWarnedOf) {
    const LoadedScene scene = read(R"("materials": [{}], "scenes": [{"nodes": [0, 1]}],
      "nodes": [{"mesh": 0, "rotation": [0, 0, 0, 0]}, {"mesh": 0, "rotation": [0, 0, 1.4142136, 1.4142136]}])");
    EXPECT_THAT(warnings_, Contains(HasSubstr("'rotation' of the node 0 that is 0")));
    const auto& still = std::get<TriangleMesh>(scene.description.shapes.at(0).geometry);
    EXPECT_LT((still.positions.at(1) - Vec3(1, 0, 0)).length(), 1e-6);
    const auto& turned = std::get<TriangleMesh>(scene.description.shapes.at(1).geometry);
    EXPECT_LT((turned.positions.at(1) - Vec3(0, 1, 0)).length(), 1e-5) << "a quarter turn, whatever the length";
}

TEST_F(GltfScene, FactorsBeyondTheirRangeAreWarnedOf) {
    const LoadedScene scene = read(R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "materials": [{"emissiveFactor": [50, 0, 0],
                     "pbrMetallicRoughness": {"baseColorFactor": [2, 1, 1, 1], "roughnessFactor": -1}}])");
    EXPECT_THAT(warnings_, Contains(HasSubstr("found 2 as 'baseColorFactor', expected 0 to 1: it counts as 1")));
    EXPECT_THAT(warnings_, Contains(HasSubstr("found -1 as 'roughnessFactor', expected 0 to 1: it counts as 0")));
    EXPECT_THAT(warnings_, Contains(HasSubstr("found 50 as 'emissiveFactor', expected 0 to 1")));
    EXPECT_EQ(scene.description.shapes.at(0).emission->radiance, Rgb(50, 0, 0));
}

TEST_F(GltfScene, ErrorsOfImagesNameTheFileAndTheImage) {
    const auto error_with = [this](const char* image) {
        return error_of(fmt::format(R"("scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}], "images": [{}],
          "textures": [{{"source": 0}}],
          "materials": [{{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0}}}}}}])",
                                    image));
    };
    const std::string file = folder_.path("scene.gltf");
    EXPECT_THAT(error_with(R"({"bufferView": 0, "mimeType": "image/png", "name": "Oak"})"),
                HasSubstr(file + ": image 0 'Oak': found 36 bytes of no known picture, expected PNG, JPEG or WebP"));
    const std::string broken = error_with(R"({"uri": "data:image/png;base64,iVBORw0KGgoAAAAA"})");
    EXPECT_THAT(broken, HasSubstr(file + ": image 0: found"));
    EXPECT_THAT(broken, testing::Not(HasSubstr("keyhole-gltf")));
    EXPECT_THAT(error_with(R"({"uri": "no.png"})"), HasSubstr(file + ": image 0: "));
    EXPECT_THAT(error_with(R"({"uri": "no.png"})"), HasSubstr("no.png: found no such file"));
}

TEST_F(GltfScene, CameraStandsWhereItsNodeIs) {
    // A quarter turn about y: what looked along -z looks along -x.
    const LoadedScene scene = read(R"("materials": [{}], "scenes": [{"nodes": [0, 1]}],
      "nodes": [{"mesh": 0}, {"camera": 0, "translation": [4, 5, 6], "rotation": [0, 0.70710678, 0, 0.70710678]}],
      "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 2, "znear": 0.1}}])");
    const CameraParameters& camera = scene.description.camera;
    EXPECT_LT((camera.origin - Vec3(4, 5, 6)).length(), 1e-6);
    EXPECT_LT((camera.forward - Vec3(-1, 0, 0)).length(), 1e-6);
    EXPECT_LT((camera.right - Vec3(0, 0, -1)).length(), 1e-6);
    EXPECT_LT((camera.up - Vec3(0, 1, 0)).length(), 1e-6);
    EXPECT_NEAR(camera.fov_degrees, 0.5 * 180 / std::numbers::pi, 1e-4);
    EXPECT_EQ(scene.description.window.width, 640);
    EXPECT_EQ(scene.description.window.height, 320);
}

TEST_F(GltfScene, MaterialsEmitAndAreClear) {
    const LoadedScene scene = read(R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "materials": [{"emissiveFactor": [1, 0.5, 0], "doubleSided": true, "alphaMode": "BLEND",
        "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25]},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}, "KHR_materials_sheen": {}}}])");
    const Shape& shape = scene.description.shapes.at(0);
    ASSERT_NE(shape.emission, nullptr);
    EXPECT_EQ(shape.emission->radiance, Rgb(4, 2, 0));
    EXPECT_TRUE(shape.emission->two_sided);
    ASSERT_NE(shape.alpha, nullptr);
    EXPECT_EQ(shape.alpha->value({}), 0.25);
    EXPECT_STREQ(shape.material->kind(), "principled");
    EXPECT_THAT(warnings_, Contains(HasSubstr("KHR_materials_sheen is left out")));
}

TEST_F(GltfScene, PanesHaveTheColourOfTheirBase) {
    const auto pane = [this](const char* roughness) {
        return read(fmt::format(R"("scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
          "materials": [{{"name": "Rose", "pbrMetallicRoughness": {{"baseColorFactor": [0.8, 0.1, 0.2, 1]{}}},
            "extensions": {{"KHR_materials_transmission": {{"transmissionFactor": 1}}}}}}])",
                                roughness))
            .description.shapes.at(0)
            .material;
    };
    const MaterialPtr clear = pane(R"(, "roughnessFactor": 0)");
    SurfacePoint point;
    point.ng = point.ns = Vec3(0, 0, 1);
    const auto lobe = clear->bsdf(point).delta(point.ns, Event::transmit);
    ASSERT_TRUE(lobe);
    EXPECT_NEAR(lobe->coefficient.y / lobe->coefficient.x, 0.125, 1e-6);
    EXPECT_NEAR(lobe->coefficient.z / lobe->coefficient.x, 0.25, 1e-6);
    EXPECT_NEAR(lobe->coefficient.x, 0.8 * (1 - 2 * 0.04 / 1.04), 1e-6) << "less what both faces reflect";
    EXPECT_THAT(warnings_, testing::Not(Contains(HasSubstr("pane"))));
    pane(R"(, "roughnessFactor": 0.4)");
    EXPECT_THAT(warnings_, Contains(HasSubstr("'Rose' has the roughness 0.4")));
}

/// The same file as a .glb.
std::string glb(std::string json) {
    const auto uri = json.find(R"(, "uri")");
    json.erase(uri, json.find('}', uri) - uri);
    json.append((4 - json.size() % 4) % 4, ' ');
    std::string bytes(44, '\0'); // 42, in whole words
    const std::array<float, 9> positions{0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::array<std::uint16_t, 3> indices{0, 1, 2};
    std::memcpy(bytes.data(), positions.data(), sizeof positions);
    std::memcpy(bytes.data() + sizeof positions, indices.data(), sizeof indices);
    const auto word = [](std::size_t n) {
        std::string w(4, '\0');
        for (std::size_t i = 0; i < 4; ++i) w[i] = static_cast<char>(n >> 8 * i);
        return w;
    };
    return "glTF" + word(2) + word(28 + json.size() + bytes.size()) + word(json.size()) + "JSON" + json +
           word(bytes.size()) + std::string("BIN\0", 4) + bytes;
}

/// Meshes ask for materials in another order than the file lists them, one for none, and one material nobody asks for.
TEST_F(GltfScene, MaterialsAreThoseOfTheirMeshes) {
    const std::string mesh = kTriangle;
    const std::string primitive = R"({"primitives": [{"attributes": {"POSITION": 0}, "indices": 1)";
    const std::string meshes = R"("meshes": [)" + primitive + R"(, "material": 3}]}, )" + primitive + "}]}, " +
                               primitive + R"(, "material": 0}]}])";
    const std::string rest = R"("scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
      "nodes": [{"mesh": 2}, {"mesh": 0}, {"mesh": 1}],
      "materials": [{"name": "same", "emissiveFactor": [1, 0, 0]}, {"name": "unused"}, {"name": "same"},
                    {"name": "same", "emissiveFactor": [0, 1, 0]}])";
    const std::string json =
        R"({"asset": {"version": "2.0"}, )" + mesh.substr(0, mesh.find(R"("meshes")")) + meshes + ", " + rest + "}";
    for (const bool packed : {false, true}) {
        const std::string path = folder_.path(packed ? "scene.glb" : "scene.gltf");
        std::ofstream(path) << (packed ? glb(json) : json);
        const LoadedScene scene = load(path, {}, nullptr);
        ASSERT_EQ(scene.description.shapes.size(), 3u);
        EXPECT_EQ(scene.description.shapes[0].emission->radiance.y, 0);
        EXPECT_GT(scene.description.shapes[0].emission->radiance.x, 0);
        EXPECT_EQ(scene.description.shapes[1].emission->radiance.x, 0);
        EXPECT_GT(scene.description.shapes[1].emission->radiance.y, 0);
        EXPECT_EQ(scene.description.shapes[2].emission, nullptr);
        EXPECT_EQ(scene.description.shapes[2].material_name, "");
    }
}

TEST_F(GltfScene, OpaqueUnlessItSaysSo) {
    const LoadedScene scene = read(R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.25]}}])");
    EXPECT_EQ(scene.description.shapes.at(0).alpha, nullptr);
    EXPECT_EQ(scene.description.shapes.at(0).emission, nullptr);
}

/// Two pixels, red with alpha 1 and green with alpha 0.2.
constexpr const char* kPngWithAlpha =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR42mP4z8DwHwiNARAsAzG+Ux4kAAAAAElFTk"
    "SuQmCC";

TEST_F(GltfScene, OpacityIsTheAlphaOfTextures) {
    const auto alpha_at = [&](const std::string& mode, float u) -> double {
        const LoadedScene scene = read(R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
          "samplers": [{"magFilter": 9728}], "textures": [{"source": 0, "sampler": 0}],
          "images": [{"uri": ")" + std::string(kPngWithAlpha) +
                                       R"("}], "materials": [{"alphaMode": ")" + mode +
                                       R"(", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.5],
          "baseColorTexture": {"index": 0}}}])");
        const FloatTexture alpha = scene.description.shapes.at(0).alpha;
        SurfacePoint point;
        point.uv = {u, 0.5f};
        return alpha != nullptr ? alpha->value(point) : 1;
    };
    EXPECT_NEAR(alpha_at("BLEND", 0.25f), 0.5, 1e-6);
    EXPECT_NEAR(alpha_at("BLEND", 0.75f), 0.1, 1e-6);
    EXPECT_EQ(alpha_at("MASK", 0.25f), 1);
    EXPECT_EQ(alpha_at("MASK", 0.75f), 0);
    EXPECT_EQ(alpha_at("OPAQUE", 0.75f), 1);
}

TEST_F(GltfScene, BrokenFilesAreErrors) {
    const std::string start = R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0)";
    EXPECT_THAT(error_of(start + R"(, "extensions": {"KHR_lights_punctual": {"light": 3}}}], "materials": [{}])"),
                HasSubstr("found no light 3"));
    EXPECT_THAT(error_of(start + R"(}], "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 7}}}])"),
                HasSubstr("textures"));
    EXPECT_THAT(error_of(start + R"(}], "materials": [{"pbrMetallicRoughness": {"metallicFactor": "much"}}])"),
                HasSubstr("scene.gltf: "));
    EXPECT_THAT(error_of(start + R"(}], "textures": [{"source": 0}], "images": [{"uri": "lost.png"}],
      "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])"),
                HasSubstr("lost.png: found no such file"));
    EXPECT_THAT(
        error_of(start + R"(}], "textures": [{"source": 0}], "images": [{"bufferView": 0, "mimeType": "image/png"}],
      "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])"),
        HasSubstr("scene.gltf: image 0: found"));
    EXPECT_THAT(error_of(start + R"(}], "materials": [{"emissiveFactor": [1, -2, 1]}])"),
                HasSubstr("found -2 as an amount of light"));
    const auto whole = [&](const std::string& content) {
        const std::string path = folder_.path("broken.glb");
        std::ofstream(path, std::ios::binary) << content;
        try {
            load(path);
        } catch (const InputError& e) {
            return std::string(e.what());
        }
        return std::string("no error");
    };
    EXPECT_THAT(whole(""), HasSubstr("found broken JSON (parse error at line 1"));
    EXPECT_THAT(whole("{}"), HasSubstr("found the glTF version ''"));
    EXPECT_THAT(whole(R"({"asset": {"version": "1.0"}})"), HasSubstr("found the glTF version '1.0'"));
    EXPECT_THAT(whole(std::string("glTF\2\0\0\0\x20\0\0\0\xFF\xFF\xFF\x7FJSON{}  ", 24)),
                HasSubstr("found a broken GLB file of 24 bytes, expected 2147483667 at least for its JSON"));
    EXPECT_THAT(whole(std::string("glTF\2\0\0\0\xFF\0\0\0", 12)),
                HasSubstr("found a broken GLB file of 12 bytes, expected more than 20"));
    EXPECT_THAT(whole(R"({"asset": {"version": "2.0"}})"), testing::Not(HasSubstr("no error")));
}

TEST_F(GltfScene, NamesOfNodesNeedNotDiffer) {
    const LoadedScene scene = read(R"("materials": [{}], "scenes": [{"nodes": [0, 1, 2, 3]}],
      "nodes": [{"mesh": 0, "name": "a", "skin": 0}, {"name": "a", "camera": 0},
                {"name": "a", "extensions": {"KHR_lights_punctual": {"light": 0}}}, {"name": "a", "mesh": 0}],
      "skins": [{"skeleton": 1, "name": "a"}], "cameras": [{"perspective": {"yfov": 1}, "name": "a"}],
      "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "name": "a"}]}})");
    EXPECT_EQ(scene.description.shapes.size(), 2u);
    EXPECT_EQ(scene.description.emitters.size(), 1u);
    EXPECT_THAT(warnings_, testing::Not(Contains(HasSubstr("found no camera"))));
    EXPECT_THAT(warnings_, Contains(HasSubstr("skins are left out")));
}

TEST_F(GltfScene, WhatIsReferredToHasToBeThere) {
    EXPECT_THAT(error_of(R"("scenes": [{"nodes": [7]}], "nodes": [{"mesh": 0}])"),
                HasSubstr("scene.gltf: found no entry 7 of 'nodes', which is referred to"));
    EXPECT_THAT(error_of(R"("scenes": [{"nodes": [0]}], "nodes": [{"children": [1]}, {"children": [0]}])"),
                HasSubstr("found node 0 below itself, expected no recursive nodes"));
    EXPECT_THAT(error_of(R"("scenes": [], "nodes": [{"mesh": 0}])"), HasSubstr("found no entry 0 of 'scenes'"));
    EXPECT_THAT(error_of(R"("scenes": [{"nodes": [0]}], "nodes": [{"mesh": 5}])"),
                HasSubstr("found no entry 5 of 'meshes'"));
}

/// What exporters hide.
TEST_F(GltfScene, NodesOfScaleZeroAreLeftOutWithAWord) {
    for (const char* scale : {"[0, 0, 0]", "[1, 1, 0]"}) {
        const LoadedScene scene = read(fmt::format(R"("scenes": [{{"nodes": [0, 1]}}], "nodes": [{{"mesh": 0}},
          {{"mesh": 0, "name": "Ghost", "scale": {}, "children": [2]}}, {{"camera": 0, "mesh": 0,
           "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}}}], "materials": [{{}}],
          "cameras": [{{"type": "perspective", "perspective": {{"yfov": 1, "znear": 0.1}}}}],
          "extensions": {{"KHR_lights_punctual": {{"lights": [{{"type": "directional"}}]}}}})",
                                                   scale));
        EXPECT_EQ(scene.description.shapes.size(), 1u);
        EXPECT_THAT(warnings_, Contains(HasSubstr("the node 1 'Ghost' and 1 more are left out: a scale of 0")));
        EXPECT_THAT(warnings_, Contains(HasSubstr("found no camera")));
        EXPECT_THAT(warnings_, Contains(HasSubstr("found no light")));
    }
}

TEST_F(GltfScene, MatricesOfNodesAreAffine) {
    const auto nodes = [](const char* last) {
        return fmt::format(R"("scenes": [{{"nodes": [0, 1]}}], "nodes": [{{"mesh": 0}}, {{"mesh": 0,
          "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.5, 0, 0, 0, {}]}}], "materials": [{{}}])",
                           last);
    };
    EXPECT_THAT(error_of(nodes("1")), HasSubstr("scene.gltf: found 'matrix' of the node 1 with the last row 0, 0, 0.5, "
                                                "1, expected 0, 0, 0, 1"));
    EXPECT_THAT(error_of(nodes("2")), HasSubstr("0, 0, 0.5, 2"));
}

} // namespace
} // namespace keyhole
