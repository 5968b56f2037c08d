// Meshes that scene files place several times are held once: pbrt's objects, groups of our files, nodes of glTF.
#include "scene/geometry.h"
#include "scene/load/load_mesh.h"
#include "support/gltf_file.h"
#include "support/mesh_copies.h"
#include "support/pbrt_scenes.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace keyhole {
namespace {

using test::dented_ball;

constexpr int kCopies = 200;

std::string pbrt_text(const TriangleMesh& mesh) {
    std::string points, indices;
    for (const Vec3& p : mesh.positions) points += fmt::format("{} {} {} ", p.x, p.y, p.z);
    for (const auto& [a, b, c] : mesh.triangles) indices += fmt::format("{} {} {} ", a, b, c);
    return "Shape \"trianglemesh\" \"point3 P\" [ " + points + "] \"integer indices\" [ " + indices + "]\n";
}

std::string pbrt_copies(int copies) {
    std::string text = "AttributeBegin ObjectInstance \"o\" AttributeEnd\n";
    for (int i = 1; i < copies; ++i)
        text += fmt::format("AttributeBegin Translate {} 0 0 Scale -1 2 1 ObjectInstance \"o\" AttributeEnd\n", i);
    return text;
}

const MeshInstance& instance(const Shape& shape) { return std::get<MeshInstance>(shape.geometry); }

/// Of the first position of a copy.
Vec3 first_position(const Shape& shape) { return instance(shape).to_world->point(instance(shape).mesh->positions[0]); }

TEST(PbrtInstances, HoldTheMeshesOfAnObjectOnce) {
    const std::string object = "ObjectBegin \"o\" Translate 0 5 0 " + pbrt_text(dented_ball(30, 20)) +
                               "ReverseOrientation " + pbrt_text(dented_ball(30, 20)) + kPbrtTriangle +
                               "Shape \"sphere\" ObjectEnd\n";
    const PbrtScene s(object + pbrt_copies(kCopies));
    const auto& shapes = s.scene.description.shapes;
    ASSERT_EQ(shapes.size(), 4u * kCopies);
    EXPECT_EQ(instance(shapes[0]).mesh, instance(shapes[4]).mesh);
    EXPECT_EQ(instance(shapes[4]).to_world, instance(shapes[5]).to_world) << "one copy";
    EXPECT_NE(instance(shapes[4]).to_world, instance(shapes[8]).to_world);
    EXPECT_EQ(held_meshes(shapes).size(), 2u + kCopies + (kCopies - 1))
        << "single triangles and spheres aren't worth it";
    const Vec3 there = first_position(shapes[4]), p = dented_ball(30, 20).positions[0];
    EXPECT_LT((there - Vec3(1 - p.x, 2 * (p.y + 5), p.z)).length(), 1e-5f);
    for (const std::size_t i : {0, 4}) {
        const SurfacePoint out = triangle_point(shapes[i], 100, 0.3f, 0.3f),
                           in = triangle_point(shapes[i + 1], 100, 0.3f, 0.3f);
        EXPECT_LT(out.ng.dot(in.ng), -0.99f) << "reversed";
        EXPECT_GT(out.ng.dot(out.p - instance(shapes[i]).to_world->point({0.1f, 4.8f, 0})), 0);
    }
}

TEST(PbrtInstances, OfFewTrianglesStandForThemselves) {
    const PbrtScene s("ObjectBegin \"o\" " + pbrt_text(dented_ball(30, 20)) + "ObjectEnd\n" + pbrt_copies(3));
    EXPECT_EQ(s.mesh(2).triangles.size(), dented_ball(30, 20).triangles.size());
}

TEST(PbrtInstances, CountOnceTowardsTheLimit) {
    // 2^27 triangles are the most that are held; these would be as many and a half.
    const TriangleMesh mesh = dented_ball(100, 100);
    const PbrtScene s("ObjectBegin \"o\" " + pbrt_text(mesh) + "ObjectEnd\n" + pbrt_copies(10'000));
    EXPECT_GT(mesh.triangles.size() * s.scene.description.shapes.size(), kMaxTriangles);
    EXPECT_EQ(held_meshes(s.scene.description.shapes).size(), 1u);
}

TEST(PbrtInstances, MayBeFlattenedByTheirTransform) {
    const std::string object = "ObjectBegin \"o\" " + pbrt_text(dented_ball(30, 20)) + "ObjectEnd\n";
    EXPECT_THAT(pbrt_error(object + pbrt_copies(kCopies) + "Scale 1 0 1 ObjectInstance \"o\""),
                testing::HasSubstr("found a transform that flattens the shape"));
    // Regular, but what goes back and forth between the spaces loses its digits.
    const PbrtScene s(object + pbrt_copies(kCopies) +
                      "Transform [1 0 0 0  1 0.0001 0 0  0 0 1 0  0 0 0 1] ObjectInstance \"o\"");
    EXPECT_TRUE(std::holds_alternative<TriangleMesh>(s.scene.description.shapes.back().geometry));
    EXPECT_THAT(pbrt_error(object + pbrt_copies(kCopies) + "Translate 1e14 0 0 ObjectInstance \"o\""),
                testing::HasSubstr("too large or too far"));
}

TEST(PbrtInstances, ThatAreFlattenedCountTowardsTheLimit) {
    // Sheared so much that no copy can be an instance.
    EXPECT_THAT(pbrt_error("ObjectBegin \"o\" " + pbrt_text(dented_ball(100, 100)) +
                           "ObjectEnd Transform [1 0 0 0  1 0.0001 0 0  0 0 1 0  0 0 0 1]\n" + pbrt_copies(10'000)),
                testing::HasSubstr(fmt::format("or {} triangles, expected fewer", kMaxTriangles)));
}

/// The object's own unit may be as small as it likes.
TEST(SharedMesh, KeepsSmallTriangles) {
    TriangleMesh ball = dented_ball(30, 20);
    const std::size_t triangles = ball.triangles.size();
    transform_mesh(ball, Imath::M44d().setScale(1e-12));
    ball.triangles.push_back({5, 5, 6});
    const SharedMesh shared(std::move(ball));
    EXPECT_EQ(shared.mesh().triangles.size(), triangles);
    const Geometry placed = shared.placed(std::make_shared<const ObjectToWorld>(Imath::M44d().setScale(1e12)));
    ASSERT_TRUE(std::holds_alternative<TriangleMesh>(placed)) << "rays can't be told from nothing where it is so small";
    EXPECT_TRUE(has_area(placed));
}

class YamlInstances : public testing::Test {
  protected:
    YamlInstances() { directory_.write("ball.obj", test::obj_text(dented_ball(30, 20))); }
    LoadedScene read(const std::string& group, int copies, const std::string& rest = "") {
        std::string text =
            "camera: {from: [0, 0, 9], to: [0, 0, 0]}\nmaterials:\n  white: {type: diffuse}\n  lamp: {type: diffuse}\n"
            "groups:\n  ball:\n" +
            group + "shapes:\n" + rest;
        for (int i = 0; i < copies; ++i)
            text += fmt::format("  - {{type: instance, group: ball, material: white, transform: [{{scale: [-1, 1, "
                                "2]}}, {{translate: [{}, 0, 0]}}]}}\n",
                                i);
        return load(directory_.write("scene.yaml", text));
    }
    ScratchDirectory directory_;
};

TEST_F(YamlInstances, HoldTheMeshesOfAGroupOnce) {
    const auto scene = read("    - {type: mesh, file: ball.obj, transform: {translate: [0, 3, 0]}}\n"
                            "    - {type: mesh, file: ball.obj, flip: true}\n"
                            "    - {type: box}\n"
                            "    - {type: mesh, file: ball.obj, emission: {power: 1}}\n",
                            kCopies, "  - {type: mesh, file: ball.obj, material: white}\n");
    const auto& shapes = scene.description.shapes;
    ASSERT_EQ(shapes.size(), 1 + 4u * kCopies);
    EXPECT_EQ(held_meshes(shapes).size(), 1 + 2u + 2u * kCopies) << "boxes and lamps have their own";
    EXPECT_EQ(instance(shapes[1]).mesh, instance(shapes[5]).mesh);
    EXPECT_NE(instance(shapes[1]).mesh, instance(shapes[2]).mesh);
    EXPECT_EQ(instance(shapes[5]).to_world, instance(shapes[6]).to_world) << "one copy";
    const TriangleMesh ball = std::get<TriangleMesh>(shapes[0].geometry);
    const SurfacePoint p = triangle_point(ball, 50, 0.3f, 0.3f);
    // Mirrored: the second corner and the third change places.
    const SurfacePoint moved = triangle_point(shapes[5], 50, 0.3f, 0.3f),
                       in = triangle_point(shapes[6], 50, 0.3f, 0.3f);
    EXPECT_LT((moved.p - Vec3(1 - p.p.x, p.p.y + 3, 2 * p.p.z)).length(), 1e-5f);
    const Vec3 normal = Vec3(-p.ng.x, p.ng.y, p.ng.z / 2).normalized();
    EXPECT_LT((moved.ng - normal).length(), 1e-5f);
    EXPECT_LT((in.ng + normal).length(), 1e-5f) << "flipped";
}

TEST_F(YamlInstances, OfFewTrianglesStandForThemselves) {
    const auto scene = read("    - {type: mesh, file: ball.obj}\n", 3);
    for (const Shape& shape : scene.description.shapes)
        EXPECT_TRUE(std::holds_alternative<TriangleMesh>(shape.geometry));
}

TEST_F(YamlInstances, OfOneMeshInSeveralGroupsAreApart) {
    const auto scene = read("    - &ball {type: mesh, file: ball.obj, transform: {scale: 2}}\n"
                            "    - {type: group, transform: {translate: [0, 9, 0]}, shapes: [*ball]}\n",
                            kCopies);
    const auto& shapes = scene.description.shapes;
    ASSERT_EQ(shapes.size(), 2u * kCopies);
    const SurfacePoint a = triangle_point(shapes[2], 50, 0.3f, 0.3f), b = triangle_point(shapes[3], 50, 0.3f, 0.3f);
    EXPECT_LT((b.p - a.p - Vec3(0, 9, 0)).length(), 1e-4f);
}

/// Many nodes that have one mesh.
void fill_with_copies(test::GltfFile& file, const TriangleMesh& mesh) {
    std::vector<float> numbers;
    std::vector<std::uint32_t> indices;
    for (const Vec3& p : mesh.positions) numbers.insert(numbers.end(), {p.x, p.y, p.z});
    for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
    file.attribute("POSITION", file.accessor(numbers, 3));
    file.primitive()["indices"] = file.accessor(indices, 1);
    auto& root = file.root;
    root["nodes"] = nlohmann::json::array();
    root["scenes"][0]["nodes"] = nlohmann::json::array();
    for (int i = 0; i < kCopies; ++i) {
        root["nodes"].push_back(
            {{"mesh", 0}, {"translation", {i, 0, 0}}, {"scale", {1, -2, 1}}, {"name", "copy " + std::to_string(i)}});
        root["scenes"][0]["nodes"].push_back(i);
    }
}

TEST(GltfInstancesOfMeshes, HoldThemOnce) {
    test::GltfFile file;
    const TriangleMesh mesh = dented_ball(30, 20);
    fill_with_copies(file, mesh);
    auto& root = file.root;
    const LoadedScene scene = file.read();
    const auto& shapes = scene.description.shapes;
    ASSERT_EQ(shapes.size(), std::size_t{kCopies});
    EXPECT_EQ(held_meshes(shapes).size(), 1u);
    const Vec3 p = triangle_point(mesh, 50, 0.3f, 0.3f).p, there = triangle_point(shapes[7], 50, 0.3f, 0.3f).p;
    EXPECT_LT((there - Vec3(7 + p.x, -2 * p.y, p.z)).length(), 1e-5f);
    EXPECT_EQ(import_mesh(file.write()).triangles.size(), mesh.triangles.size() * kCopies);
    // What emits has triangles of its own.
    root["materials"][0] = {{"emissiveFactor", {1, 1, 1}}};
    EXPECT_EQ(Scene(file.read().description).emitters().size(), std::size_t{kCopies});
}

TEST(GltfInstancesOfMeshes, ThatAreOpenAreToldOfOnce) {
    test::GltfFile file;
    TriangleMesh mesh = dented_ball(30, 20);
    mesh.triangles.pop_back();
    fill_with_copies(file, mesh);
    file.root["materials"][0] = nlohmann::json::parse(
        R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"thicknessFactor": 0.2, "attenuationDistance": 0.5,
                                     "attenuationColor": [0.25, 1, 0]}}})");
    for (const Shape& shape : file.read().description.shapes) EXPECT_EQ(shape.inside, nullptr);
    EXPECT_EQ(std::ranges::count_if(file.warnings,
                                    [](const std::string& w) { return w.find("isn't closed") != std::string::npos; }),
              1);
}

TEST(GltfInstancesOfMeshes, AreAllSeenWhereThereIsNoCamera) {
    test::GltfFile file;
    fill_with_copies(file, dented_ball(30, 20));
    const LoadedScene scene = file.read();
    const Camera camera(scene.description.camera, scene.description.window);
    const SurfacePoint eye = camera.eye(0.5, 0.5);
    for (const Shape& shape : scene.description.shapes) {
        const SurfacePoint p = triangle_point(shape, 50, 0.3f, 0.3f);
        EXPECT_TRUE(camera.image_point(eye, (p.p - eye.p).normalized()));
    }
}

} // namespace
} // namespace keyhole
