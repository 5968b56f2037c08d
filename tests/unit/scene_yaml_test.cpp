// What good scene files turn into.
#include "core/error.h"
#include "sampling/proposals/registry.h"
#include "scene/geometry.h"
#include "scene/load/load.h"
#include "support/scratch_directory.h"
#include "support/signed_volume.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace keyhole {
namespace {

const std::string kCamera = "camera: {from: [0, 0, 3], to: [0, 0, 0]}\n";
const std::string kMaterials = "materials: {white: {type: diffuse}, ball: {type: mirror, reflectance: 0.9}}\n";
const std::string kData = KEYHOLE_SOURCE_DIR "/tests/data/";

void expect_near(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
    EXPECT_LT((a - b).length(), tolerance) << a << " is not " << b;
}

class SceneYaml : public testing::Test {
  protected:
    LoadedScene load(const std::string& text, const std::vector<std::string>& overrides = {}) {
        return load_scene(directory.write("scene.yaml", text), overrides);
    }
    Shape load_shape(const std::string& shape) {
        auto scene = load(kCamera + kMaterials + "shapes:\n  - " + shape + "\n");
        EXPECT_EQ(scene.description.shapes.size(), 1u);
        return std::move(scene.description.shapes.front());
    }
    TriangleMesh load_mesh(const std::string& shape) { return std::get<TriangleMesh>(load_shape(shape).geometry); }
    Sphere load_sphere(const std::string& shape) { return std::get<Sphere>(load_shape(shape).geometry); }

    ScratchDirectory directory;
};

Vec3 face_normal(const TriangleMesh& mesh, std::uint32_t i) { return triangle_point(mesh, i, 0.3f, 0.3f).ng; }

TEST_F(SceneYaml, DefaultsStandWhereAFileIsSilent) {
    const auto scene = load(kCamera + "shapes: [{type: sphere, material: {type: diffuse}}]\n");
    const auto& camera = scene.description.camera;
    EXPECT_EQ(scene.description.window.width, 640);
    EXPECT_EQ(scene.description.window.height, 480);
    EXPECT_EQ(camera.fov_degrees, 40);
    EXPECT_EQ(camera.lens_radius, 0);
    EXPECT_EQ(camera.focus_distance, 3);
    EXPECT_EQ(scene.settings.spp, Settings().spp);
    EXPECT_TRUE(scene.description.emitters.empty());
}

TEST_F(SceneYaml, CameraLookingDownMinusZSeesPlusXToTheRight) {
    const auto scene = load("camera: {from: [1, 2, 3], to: [1, 2, -5], fov: 60, lens_radius: 0.5, focus_distance: 2}\n"
                            "film: {resolution: [40, 30]}\nshapes: [{type: sphere, material: {type: diffuse}}]\n");
    const auto& camera = scene.description.camera;
    expect_near(camera.origin, {1, 2, 3});
    expect_near(camera.right, {1, 0, 0});
    expect_near(camera.up, {0, 1, 0});
    expect_near(camera.forward, {0, 0, -1});
    EXPECT_EQ(camera.fov_degrees, 60);
    EXPECT_EQ(camera.lens_radius, 0.5f);
    EXPECT_EQ(camera.focus_distance, 2);
    EXPECT_EQ(scene.description.window.width, 40);
}

TEST_F(SceneYaml, CameraFrameIsOrthonormalForAnyUp) {
    const auto scene = load("camera: {from: [1, 2, 3], to: [-4, 1, 0], up: [3, 9, -1]}\n"
                            "shapes: [{type: sphere, material: {type: diffuse}}]\n");
    const auto& c = scene.description.camera;
    expect_near(c.right.cross(c.up), -c.forward);
    expect_near(c.right.cross(c.forward), c.up);
    EXPECT_NEAR(c.right.length(), 1, 1e-6);
    EXPECT_GT(c.up.dot(Vec3(3, 9, -1)), 0);
}

TEST_F(SceneYaml, MaterialsCarryTheirParameters) {
    const auto scene =
        load(kCamera + "materials:\n  a: {type: diffuse, reflectance: [0.1, 0.2, 0.3]}\n  b: {type: mirror, "
                       "reflectance: 0.9}\n  c: {type: glass, ior: 1.3, transmit_tint: 0.5}\n"
                       "shapes: [{type: sphere, material: a}, {type: sphere, material: b}, {type: sphere, "
                       "material: c}, {type: sphere, material: a}]\n");
    const auto& shapes = scene.description.shapes;
    ASSERT_EQ(shapes.size(), 4u);
    const auto model = [&](std::size_t i) { return shapes[i].material->bsdf(SurfacePoint()).model(); };
    const auto near = [](const Rgb& a, const Rgb& b) { return a.equalWithAbsError(b, 1e-6); };
    EXPECT_TRUE(near(std::get<DiffuseBsdf>(model(0)).reflectance, Rgb(0.1, 0.2, 0.3)));
    EXPECT_TRUE(near(std::get<MirrorBsdf>(model(1)).reflectance, Rgb(0.9)));
    EXPECT_EQ(std::get<GlassBsdf>(model(2)).eta, 1.3);
    EXPECT_TRUE(near(std::get<GlassBsdf>(model(2)).transmit_tint, Rgb(0.5)));
    EXPECT_EQ(shapes[0].material, shapes[3].material);
}

TEST_F(SceneYaml, RectangleFacesPlusZAndUCrossV) {
    const auto unit = load_mesh("{type: rectangle, material: white}");
    expect_near(face_normal(unit, 0), {0, 0, 1});
    expect_near(face_normal(unit, 1), {0, 0, 1});
    expect_near(unit.positions[0], {-1, -1, 0});
    expect_near(unit.positions[2], {1, 1, 0});
    const auto other = load_mesh("{type: rectangle, material: white, corner: [1, 1, 1], u: [0, 0, 2], v: [3, 0, 0]}");
    expect_near(face_normal(other, 0), {0, 1, 0});
    expect_near(other.positions[2], {4, 1, 3});
}

TEST_F(SceneYaml, BoxEnclosesItsVolumeOutsideOutward) {
    EXPECT_NEAR(test::signed_volume(load_mesh("{type: box, material: white, min: [1, 2, 3], max: [2, 4, 6]}")), 6,
                1e-5);
    EXPECT_NEAR(test::signed_volume(load_mesh("{type: box, material: white, flip: true}")), -8, 1e-5);
}

TEST_F(SceneYaml, TransformsActFirstToLast) {
    const auto mesh =
        load_mesh("{type: rectangle, material: white, transform: [{scale: [2, 2, 1]}, {rotate: [90, 1, 0, 0]}, "
                  "{translate: [0, 1, 0]}]}");
    // (1,1,0) -> (2,2,0) -> (2,0,2) -> (2,1,2): a quarter turn takes +y to +z.
    expect_near(mesh.positions[2], {2, 1, 2});
    expect_near(face_normal(mesh, 0), {0, -1, 0});
    const auto other = load_mesh("{type: rectangle, material: white, transform: [{translate: [0, 1, 0]}, {scale: 3}]}");
    expect_near(other.positions[2], {3, 6, 0});
}

TEST_F(SceneYaml, MatrixActsOnColumnsAsInTextbooks) {
    const auto mesh =
        load_mesh("{type: rectangle, material: white, transform: {matrix: [0,-2,0,5, 2,0,0,6, 0,0,1,7, 0,0,0,1]}}");
    expect_near(mesh.positions[1], {-2 * -1 + 5, 2 * 1 + 6, 7}); // of (1, -1, 0)
}

TEST_F(SceneYaml, MirroredTransformKeepsTheOutsideOutside) {
    EXPECT_NEAR(test::signed_volume(load_mesh("{type: box, material: white, transform: [{scale: [-1, 2, 1]}]}")), 16,
                1e-5);
    EXPECT_NEAR(test::signed_volume(load_mesh("{type: box, material: white, transform: [{scale: -1}]}")), 8, 1e-5);
    const auto ball = load_mesh("{type: sphere, material: white, transform: [{scale: [-1, 2, 3]}]}");
    EXPECT_NEAR(test::signed_volume(ball), 4 * kPi / 3 * 6, 0.02);
    for (std::uint32_t i = 0; i < ball.triangles.size(); ++i)
        EXPECT_GT(face_normal(ball, i).dot(ball.normals[ball.triangles[i][0]]), 0.9f);
    EXPECT_FALSE(load_sphere("{type: sphere, material: white, transform: [{scale: -2}]}").inward);
}

TEST_F(SceneYaml, SphereStaysOneUnderUniformTransforms) {
    const auto sphere =
        load_sphere("{type: sphere, material: ball, center: [1, 0, 0], radius: 0.5, transform: [{scale: 3}, "
                    "{rotate: [90, 0, 0, 1]}, {translate: [0, 0, 1]}]}");
    expect_near(sphere.center, {0, 3, 1});
    EXPECT_FLOAT_EQ(sphere.radius, 1.5f);
    EXPECT_TRUE(load_sphere("{type: sphere, material: ball, flip: true}").inward);
}

TEST_F(SceneYaml, StretchedSphereBecomesAnEllipsoidWithItsNormals) {
    const auto mesh = load_mesh("{type: sphere, material: ball, center: [1, 1, 1], transform: [{scale: [1, 2, 4]}]}");
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); i += 97) {
        const Vec3 p = mesh.positions[i] - Vec3(1, 2, 4);
        EXPECT_NEAR(p.x * p.x + p.y * p.y / 4 + p.z * p.z / 16, 1, 1e-5);
        expect_near(mesh.normals[i], Vec3(p.x, p.y / 4, p.z / 16).normalized(), 1e-4f);
    }
    const auto inward = load_mesh("{type: sphere, material: ball, flip: true, transform: [{scale: [1, 1, 2]}]}");
    EXPECT_LT(test::signed_volume(inward), 0);
}

TEST_F(SceneYaml, EmittedPowerFollowsFromAreaAndSides) {
    const auto one = load_shape("{type: rectangle, emission: {power: [1, 2, 3]}, transform: {scale: 2}}");
    EXPECT_NEAR(one.emission->radiance.y, 2 / (kPi * 16), 1e-6);
    EXPECT_FALSE(one.emission->two_sided);
    const auto two = load_shape("{type: rectangle, emission: {power: 1, two_sided: true}}");
    EXPECT_NEAR(two.emission->radiance.x, 1 / (2 * kPi * 4), 1e-6);
    const auto ball = load_shape("{type: sphere, radius: 2, material: white, emission: {radiance: 7}}");
    EXPECT_EQ(ball.emission->radiance, Rgb(7.0));
    EXPECT_EQ(load_shape("{type: sphere, emission: {radiance: 0}}").emission, nullptr);
}

TEST_F(SceneYaml, PointEmitterHasItsPower) {
    const auto scene = load(kCamera + "shapes: [{type: sphere, material: {type: diffuse}}]\nemitters:\n"
                                      "  - {type: point, position: [1, 2, 3], intensity: [1, 1, 1]}\n"
                                      "  - {type: point, position: [0, 0, 0], power: 5}\n");
    const auto& emitters = scene.description.emitters;
    ASSERT_EQ(emitters.size(), 2u);
    EXPECT_NEAR(emitters[0]->power(), 4 * kPi, 1e-12);
    EXPECT_NEAR(emitters[1]->power(), 5, 1e-12);
    Rng rng(1, StreamPurpose::test, 0);
    const auto [point, pdf] = emitters[0]->sample_point(rng);
    EXPECT_EQ(point.p, Vec3(1, 2, 3));
    EXPECT_EQ(point.site, Site::point);
    EXPECT_EQ(pdf, 1);
    const EmitterRay ray = emitters[0]->sample_ray(point, rng);
    EXPECT_NEAR(ray.w.length(), 1, 1e-6);
    EXPECT_NEAR(ray.pdf * 4 * kPi, 1, 1e-12);
}

TEST_F(SceneYaml, GroupsPlaceTheirShapesInsideTheirTransform) {
    const auto scene =
        load(kCamera + kMaterials +
             "groups:\n  pair: [{type: sphere, radius: 0.5}, {type: sphere, material: ball, center: [1, 0, 0]}]\n"
             "shapes:\n  - {type: instance, group: pair, material: white, transform: {translate: [0, 5, 0]}}\n"
             "  - type: group\n    transform: [{scale: 2}]\n    material: ball\n    shapes:\n"
             "      - {type: instance, group: pair, transform: [{translate: [1, 0, 0]}]}\n");
    const auto& shapes = scene.description.shapes;
    ASSERT_EQ(shapes.size(), 4u);
    expect_near(std::get<Sphere>(shapes[1].geometry).center, {1, 5, 0});
    expect_near(std::get<Sphere>(shapes[3].geometry).center, {4, 0, 0});
    EXPECT_FLOAT_EQ(std::get<Sphere>(shapes[2].geometry).radius, 1);
    EXPECT_STREQ(shapes[0].material->kind(), "diffuse");
    EXPECT_STREQ(shapes[1].material->kind(), "mirror");
    EXPECT_STREQ(shapes[2].material->kind(), "mirror");
}

/// Each twice in the one before it: 2^40 of them.
TEST_F(SceneYaml, GroupsThatHoldNothingAreReadOnce) {
    std::string groups = "groups:\n  g40: []\n";
    for (int i = 0; i < 40; ++i) {
        const std::string next = "{type: instance, group: g" + std::to_string(i + 1) + "}";
        groups += "  g" + std::to_string(i) + ": [" + next + ", " + next + "]\n";
    }
    const auto scene = load(kCamera + kMaterials + groups +
                            "shapes: [{type: sphere, material: white}, {type: instance, group: g0}]\n");
    EXPECT_EQ(scene.description.shapes.size(), 1u);
}

TEST_F(SceneYaml, IncludesConcatenateAndAreOverruled) {
    std::filesystem::create_directory(directory.path("parts"));
    directory.write("parts/room.yaml", "include: common.yaml\nfilm: {resolution: [10, 20]}\n"
                                       "camera: {from: [0, 0, 3], to: [0, 0, 0], fov: 33}\nrender: {spp: 7, seed: 9}\n"
                                       "shapes: [{type: sphere, material: white, radius: 2}]\n"
                                       "emitters: [{type: point, position: [0, 0, 0], power: 1}]\n");
    directory.write("parts/common.yaml", kMaterials + "shapes: [{type: box, material: white}]\n");
    const auto scene = load("shapes: [{type: sphere, material: ball, radius: 3}]\ncamera: {from: [0, 0, 9]}\n"
                            "render: {spp: 8}\ninclude: [parts/room.yaml, parts/common.yaml]\n");
    EXPECT_EQ(scene.description.shapes.size(), 3u); // common.yaml once
    EXPECT_EQ(scene.description.emitters.size(), 1u);
    EXPECT_EQ(std::get<Sphere>(scene.description.shapes[2].geometry).radius, 3);
    EXPECT_EQ(scene.description.window.height, 20);
    EXPECT_EQ(scene.description.camera.fov_degrees, 33);
    expect_near(scene.description.camera.origin, {0, 0, 9});
    EXPECT_EQ(scene.settings.spp, 8);
    EXPECT_EQ(scene.settings.seed, 9u);
}

TEST_F(SceneYaml, IncludeCycleIsReported) {
    directory.write("a.yaml", "include: b.yaml\n");
    directory.write("b.yaml", "include: ./a.yaml\n");
    try {
        load("include: a.yaml\n");
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("b.yaml:1:10: found"));
        EXPECT_THAT(e.what(), testing::HasSubstr("including itself"));
    }
}

TEST_F(SceneYaml, AnchorsMayBeReused) {
    const auto mesh =
        load_mesh("{type: box, material: white, min: &a [0, 0, 0], max: [1, 1, 1], transform: {translate: *a}}");
    EXPECT_NEAR(test::signed_volume(mesh), 1, 1e-6);
}

TEST_F(SceneYaml, ObjQuadIsTwoFlatTriangles) {
    const auto mesh =
        load_mesh("{type: mesh, material: white, file: " + kData + "quad.obj, transform: {scale: [1, 1, -1]}}");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_TRUE(mesh.normals.empty());
    expect_near(face_normal(mesh, 0), {0, 0, -1}); // what faced +z now faces -z
    const auto smooth = load_mesh("{type: mesh, material: white, smooth: true, file: " + kData + "quad.obj}");
    ASSERT_EQ(smooth.normals.size(), smooth.positions.size());
    expect_near(smooth.normals[0], {0, 0, 1});
}

TEST_F(SceneYaml, ObjNumbersMayBeginWithTheirPoint) {
    directory.write("points.obj", "v 0 0 0\nv 1 0 0\nv .5 1 -.25\nv 0\t.125 .0\nf 1 2 3\nf 1 2 4\n");
    const auto mesh = load_mesh("{type: mesh, material: white, file: points.obj}");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    expect_near(mesh.positions.at(mesh.triangles[0][2]), {0.5f, 1, -0.25f});
    expect_near(mesh.positions.at(mesh.triangles[1][2]), {0, 0.125f, 0});
}

TEST_F(SceneYaml, PlyNormalsAreKeptUnlessNotSmooth) {
    const auto mesh = load_mesh("{type: mesh, material: white, file: " + kData + "tent.ply}");
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (mesh.positions[i].x == 1)
            expect_near(mesh.normals[i], Vec3(1, 0, 1).normalized());
        else if (mesh.positions[i].x == 0)
            expect_near(mesh.normals[i], {0, 0, 1});
    EXPECT_TRUE(load_mesh("{type: mesh, material: white, smooth: false, file: " + kData + "tent.ply}").normals.empty());
}

TEST_F(SceneYaml, GltfPartsStandWhereItsNodesPlaceThem) {
    const auto mesh = load_mesh("{type: mesh, material: white, file: " + kData + "two_placements.gltf}");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    expect_near(face_normal(mesh, 0), {0, 0, 1});
    expect_near(face_normal(mesh, 1), {0, 0, 1}); // mirrored, outside still outside
    float least = 0, most = 0;
    for (const Vec3& p : mesh.positions) least = std::min(least, p.x), most = std::max(most, p.x);
    EXPECT_EQ(least, -1);
    EXPECT_EQ(most, 11);
}

TEST_F(SceneYaml, DegenerateTrianglesAndZeroNormalsAreMended) {
    directory.write("odd.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nvn 0 0 0\nvn 0 0 1\nf 1//1 2//2 3//2\nf 1//1 2//1 4//1\n");
    const auto mesh = load_mesh("{type: mesh, material: white, file: odd.obj}");
    EXPECT_EQ(mesh.triangles.size(), 1u);
    for (const auto i : mesh.triangles[0]) expect_near(mesh.normals[i], {0, 0, 1});
}

TEST_F(SceneYaml, MeshesWithoutAreaAreLeftOutAndNamed) {
    directory.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    const std::string path = directory.write(
        "scene.yaml",
        kCamera + kMaterials +
            "shapes:\n  - {type: mesh, material: white, file: flat.obj}\n  - {type: box, material: white}\n"
            "  - {type: mesh, file: flat.obj, emission: {power: 3}}\n");
    std::vector<std::string> warnings;
    const auto loaded = load_scene(path, {}, &warnings);
    EXPECT_EQ(loaded.description.shapes.size(), 1u);
    ASSERT_EQ(warnings.size(), 2u);
    EXPECT_EQ(warnings[0], path + ":4:5: mesh 'flat.obj': no triangle of the mesh has an area: it is left out");
    EXPECT_EQ(warnings[1].find(path + ":6:5: "), 0u);
}

TEST_F(SceneYaml, OverridesFollowTheFileInTheirOrder) {
    const auto scene =
        load(kCamera + kMaterials + "shapes: [{type: box, material: white}]\nrender: {method: path, spp: 3}\n",
             {"spp=4", "photons=100k", "mutations=2.5M", "importons=1e6", "spp=5", "lens_subpath.weight=0.25"});
    EXPECT_EQ(scene.settings.method, &method_named("path"));
    EXPECT_EQ(scene.settings.spp, 5);
    EXPECT_EQ(scene.settings.photons, 100'000);
    EXPECT_EQ(scene.settings.mutations, 2'500'000);
    EXPECT_EQ(scene.settings.importons, 1'000'000);
    EXPECT_EQ(scene.settings.proposals[proposals::lens_subpath.weight], 0.25);
}

/// What plans print is what settings take.
TEST(ApplyOverride, TakesBytesByThousandsToo) {
    Settings settings;
    for (const auto& [text, bytes] : {std::pair("33.6MB", 33'600'000ll),
                                      {"300kB", 300'000},
                                      {"2GB", 2'000'000'000},
                                      {"17TB", 17'000'000'000'000},
                                      {"1TiB", 1ll << 40},
                                      {"500000B", 500'000},
                                      {"32MiB", 32ll << 20}}) {
        apply_override(settings, std::string("photon_memory=") + text);
        EXPECT_EQ(settings.photon_memory, bytes) << text;
    }
    for (const char* text : {"MB", "B", "32mB", "32MBB", "32iB", "32BB", "32MB ", "32 MB", "32kBi", "1e6iB"})
        EXPECT_THROW(apply_override(settings, std::string("photon_memory=") + text), InputError) << text;
}

TEST(ApplyOverride, RefusesWhatIsNotASetting) {
    Settings settings;
    for (const char* text : {"",
                             "=",
                             "spp",
                             "=4",
                             "spp=",
                             "spp=four",
                             "spp=0",
                             "spp=-1",
                             "spp=1e300",
                             "spp=nan",
                             "spp=4 ",
                             "spp= 4",
                             "spp=0x10",
                             "sp=4",
                             "SPP=4",
                             "method=",
                             "method=mp",
                             "bidirectional.weight=inf",
                             "bidirectional.weight=-0.1",
                             "photons=k",
                             "photons=1.0001k",
                             "seed=99999999999999999999"})
        EXPECT_THROW(apply_override(settings, text), InputError) << text;
    EXPECT_EQ(settings.spp, Settings().spp);
    try {
        apply_override(settings, "photns=4");
        FAIL();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::HasSubstr("unknown setting 'photns'"));
        EXPECT_THAT(e.what(), testing::HasSubstr("did you mean 'photons'?"));
    }
}

TEST(SettingsText, OldNamesKeepWorkingWithAWarning) {
    Settings settings;
    std::vector<std::string> warnings;
    apply_override(settings, "p_lens_subpath=0.5", &warnings);
    EXPECT_EQ(settings.proposals[proposals::lens_subpath.weight], 0.5);
    apply_override(settings, "reach=off", &warnings);
    EXPECT_FALSE(settings.gather_coverage);
    apply_override(settings, "reach=auto", &warnings);
    EXPECT_TRUE(settings.gather_coverage);
    ASSERT_EQ(warnings.size(), 3u);
    EXPECT_EQ(warnings[0], "the setting 'p_lens_subpath' is called 'lens_subpath.weight' now");
    EXPECT_EQ(warnings[1], "the setting 'reach' is called 'gather_coverage' now");
    apply_override(settings, "lens_subpath.weight=0.25", &warnings);
    EXPECT_EQ(warnings.size(), 3u);
    EXPECT_THROW(apply_override(settings, "p_unheard_of=1"), InputError);
}

TEST(SettingsText, OffersEveryMethodAndEveryProposal) {
    for (const Method* method : all_methods()) {
        Settings settings;
        apply_override(settings, "method=" + std::string(name_of(*method)));
        EXPECT_EQ(settings.method, method);
        EXPECT_EQ(&method_named(name_of(*method)), method);
    }
    for (const ProposalKind* kind : proposal_kinds()) {
        Settings settings;
        apply_override(settings, std::string(kind->weight.key) + "=0.75");
        EXPECT_EQ(settings.proposals[kind->weight], 0.75);
        EXPECT_EQ(Settings().proposals[kind->weight], kind->weight.usual);
    }
}

} // namespace
} // namespace keyhole
