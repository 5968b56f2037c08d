// Every mistake in a scene file is reported where it stands.
#include "core/error.h"
#include "scene/load/load.h"
#include "support/scratch_directory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace keyhole {
namespace {

const std::string kCamera = "camera: {from: [0, 0, 3], to: [0, 0, 0]}\n";
const std::string kShapes = "shapes:\n  - {type: sphere, material: {type: diffuse}}\n";

/// A scene with a mistake: `@` stands before the place that the message must point at, and is not part of the text.
struct Mistake {
    std::string text;
    std::string message; ///< part of it
};

Mistake in_shape(const std::string& shape, const std::string& message) {
    return {kCamera + "materials: {white: {type: diffuse}, wood: {type: diffuse}}\nshapes:\n  - " + shape + "\n",
            message};
}
Mistake in_material(const std::string& material, const std::string& message) {
    return {kCamera + kShapes + "materials:\n  red: " + material + "\n", message};
}
Mistake in_camera(const std::string& camera, const std::string& message) {
    return {kShapes + "camera: " + camera + "\n", message};
}
Mistake in_section(const std::string& section, const std::string& message) {
    return {kCamera + kShapes + section + "\n", message};
}
Mistake in_transform(const std::string& transform, const std::string& message) {
    return in_shape("{type: box, material: white, transform: " + transform + "}", message);
}
Mistake in_emission(const std::string& emission, const std::string& message) {
    return in_shape("{type: sphere, emission: " + emission + "}", message);
}

std::string repeat(const std::string& s, int n) {
    std::string all;
    for (int i = 0; i < n; ++i) all += s;
    return all;
}

std::string alias_bomb() {
    std::string text = "materials:\n  @a0: &a0 [1, 1]\n";
    for (int i = 1; i < 30; ++i) {
        const std::string before = "*a" + std::to_string(i - 1);
        text += "  a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + before + ", " + before + "]\n";
    }
    return text;
}

/// Groups of ten instances each: the number of shapes multiplies by ten a level.
std::string group_bomb() {
    std::string text = kCamera + "groups:\n  g0: [@{type: sphere, material: {type: mirror}}]\n";
    for (int i = 1; i < 9; ++i)
        text += "  g" + std::to_string(i) + ": [" +
                repeat("{type: instance, group: g" + std::to_string(i - 1) + "}, ", 10) + "]\n";
    return text + "shapes: [{type: instance, group: g8}]\n";
}

std::vector<Mistake> mistakes() {
    const std::string vertical = "{from: [0, 3, 0], to: @[0, 0, 0]}";
    return {
        // The file as a whole.
        {"@", "empty file"},
        {"@# only a comment\n", "empty file"},
        {"@[1, 2, 3]\n", "found a list of 3, expected a map"},
        {"@just words\n", "found the value 'just words', expected a map"},
        {"@null\n", "found nothing, expected a map"},
        {std::string("film: {}\nab@") + '\0' + "cd", "the byte 0x00"},
        {"\x89PNG\x0d\x0a@\x1a\x0a", "the byte 0x1a"},
        {"shapes: [1, 2\ncamera@: {}\n", "broken YAML"},
        {"film:\n  a: 1\n @b: 2\n", "broken YAML"},
        {"film:\n  a: 1\n   b@: 2\n", "indented as the lines around it"},
        {"film:\n\ta@: 1\n", "expected spaces: line 2 is indented by a tab"},
        {"film: {resolution: [4, 4]}\nshapes: @*nobody\n", "broken YAML"},
        {"film: @\"open\n", "found the string 'open"},
        {kCamera + kShapes + "@---\nfilm: {}\n", "second document"},
        {kCamera + kShapes + "film: {resolution: [4, 4]}\n@film: {resolution: [8, 8]}\n", "the key 'film' again"},
        {kCamera + kShapes + "@[a, b]: 3\n", "a key that is not a word"},
        {kCamera + "shapes: &a [@*a]\n", "alias within its own anchor"},
        {"shapes: " + repeat("[", 63) + "@" + repeat("[", 9) + repeat("]", 72) + "\n", "nested more than 64 deep"},
        {alias_bomb(), "with aliases written out"},
        {group_bomb(), "more than 1048576 shapes"},
        {"@film: {resolution: [4, 4]}\n", "found an empty scene"},
        {kCamera + "shapes: @[]\n", "found an empty scene"},
        {"@" + kShapes, "no 'from' of the camera"},
        {"@" + kShapes + "camera: {from: [0, 0, 3]}\n", "no 'to' of the camera"},
        {kCamera + kShapes + "@camra: {}\n", "unknown key 'camra' in a scene, expected one of include, film"},
        {kCamera + kShapes + "@camra: {}\n", "did you mean 'camera'?"},
        // Film and camera.
        in_section("film: @7", "found the value '7', expected a map that describes a film"),
        in_section("film: {@size: [4, 4]}", "unknown key 'size'"),
        in_section("film: {resolution: @640}", "expected [width, height]"),
        in_section("film: {resolution: @[640]}", "found a list of 1"),
        in_section("film: {resolution: [640, @0]}", "of at least 1"),
        in_section("film: {resolution: [@65537, 1]}", "at most 65536"),
        in_section("film: {resolution: [@1.5, 1]}", "without a fraction"),
        in_section("film: {resolution: @[65536, 65536]}", "found 4294967296 pixels"),
        in_camera("{from: [0, 0, 3], to: @[0, 0, 3]}", "at one place"),
        in_camera(vertical, "'up' along the view"),
        in_camera("{from: [0, 0, 3], to: [0, 0, 0], up: @[0, 0, 2]}", "'up' along the view"),
        in_camera("{from: [0, 0, 3], to: [0, 0, 0], up: @[0, 0, 0]}", "found the direction [0, 0, 0]"),
        in_camera("{from: [0, 0, 3], to: [0, 0, 0], fov: @0}", "a field of view in degrees"),
        in_camera("{from: [0, 0, 3], to: [0, 0, 0], fov: @180}", "a field of view in degrees"),
        in_camera("{from: [0, 0, 3], to: [0, 0, 0], fov: @wide}", "found the value 'wide', expected a field of view"),
        in_camera("{from: [0, 0, 3], to: [0, 0, 0], lens_radius: @-1}", "of at least 0"),
        in_camera("{from: [0, 0, 3], to: [0, 0, 0], focus_distance: @0}", "a length"),
        in_camera("{from: [0, 0, @.nan], to: [0, 0, 0]}", "found the value '.nan'"),
        in_camera("{from: [0, 0, @nan], to: [0, 0, 0]}", "a coordinate that is finite"),
        in_camera("{from: [0, 0, @inf], to: [0, 0, 0]}", "a coordinate that is finite"),
        in_camera("{from: [0, 0, @1e999], to: [0, 0, 0]}", "a coordinate"),
        in_camera("{from: [0, 0, @1e13], to: [0, 0, 0]}", "at most 1e+12"),
        in_camera("{from: @[0, 0], to: [0, 0, 0]}", "found a list of 2, expected a list of 3 numbers"),
        in_camera("{from: [0, 0, @'3'], to: [0, 0, 0]}", "found the string '3'"),
        in_camera("{from: [0, 0, @3m], to: [0, 0, 0]}", "found the value '3m'"),
        in_camera("{@form: [0, 0, 3]}", "did you mean 'from'?"),
        // Materials.
        in_section("materials: @[1]", "expected a map from names to materials"),
        in_material("@white", "expected a map that describes a material"),
        in_material("@{reflectance: 0.5}", "a material without 'type', expected one of black, coated_conductor"),
        in_material("{type: @difuse}", "did you mean 'diffuse'?"),
        in_material("{type: @[diffuse]}", "expected the type of a material"),
        in_material("{type: diffuse, reflectance: @-0.1}", "a reflectance of at least 0 and at most 1"),
        in_material("{type: diffuse, reflectance: [0.5, @1.1, 0]}", "a reflectance of at least 0 and at most 1"),
        in_material("{type: diffuse, reflectance: @[0.5, 0.5]}", "for red, green and blue"),
        in_material("{type: diffuse, @reflectance: }", "found nothing"),
        in_material("{type: diffuse, @colour: 1}",
                    "unknown key 'colour' in a diffuse material, expected one of type, reflectance"),
        in_material("{type: mirror, @ior: 1}", "unknown key 'ior' in a mirror"),
        in_material("{type: glass, ior: @0}", "a refractive index"),
        in_material("{type: conductor, roughness: @-0.1}", "a roughness of at least 0"),
        in_material("{type: conductor, roughness: @[0.1, 0.2, 0.3]}", "along the tangent and across it"),
        in_material("@{type: conductor, eta: 1}", "found 'eta' alone, expected 'eta' and 'k', or 'reflectance'"),
        in_material("@{type: conductor, eta: 1, k: 3, reflectance: 1}", "expected one or the other"),
        in_material("{type: mix, a: @pale, b: {type: black}}", "unknown material 'pale'"),
        in_material("{type: diffuse, reflectance: {type: @imag, file: a.png}}", "did you mean 'image'?"),
        in_material("{type: diffuse, reflectance: {type: image, file: @none.png}}", "found no such file"),
        in_material("{type: diffuse, reflectance: {type: image, file: @.}}",
                    "found something that is not a file, expected an image"),
        in_material("{type: diffuse, normal_map: @3}", "expected a coordinate of a normal map of at least 0"),
        in_material("{type: diffuse, reflectance: {type: checkerboard, a: 0, b: @2}}", "a reflectance"),
        in_material("{type: diffuse, bump: {type: image, file: a.png, @encodng: srgb}}", "'encoding'"),
        in_material("{type: glass, ior: @-1.5}", "a refractive index"),
        in_material("{type: glass, transmit_tint: @2}", "a tint"),
        in_section("materials:\n  a: {type: mirror}\n  @a: {type: mirror}",
                   "the key 'a' again, expected it once (first on line 5)"),
        // Shapes.
        {kCamera + "shapes: @{type: sphere}\n", "found a map, expected a list of shapes"},
        {kCamera + "@shapes: \n", "found nothing, expected a list of shapes"},
        in_shape("@sphere", "expected a map that describes a shape"),
        in_shape("@{material: white}", "a shape without 'type'"),
        in_shape("{type: @spere, material: white}", "did you mean 'sphere'?"),
        in_shape("@{type: sphere}", "a sphere without 'material'"),
        in_shape("{type: sphere, material: @wihte}",
                 "unknown material 'wihte', expected one of white, wood; did you mean 'white'?"),
        in_shape("{type: sphere, material: @[white]}", "expected the name of a material"),
        in_shape("{type: sphere, material: white, radius: @0}", "a radius"),
        in_shape("{type: sphere, material: white, radius: @-1}", "a radius"),
        in_shape("{type: sphere, material: white, @centre: [0, 0, 0]}", "did you mean 'center'?"),
        in_shape("{type: sphere, material: white, @min: [0, 0, 0]}", "unknown key 'min' in a sphere"),
        in_shape("{type: sphere, material: white, flip: @yes}", "found the value 'yes', expected true or false"),
        in_shape("@{type: rectangle, material: white, corner: [0, 0, 0], u: [1, 0, 0]}", "a rectangle without 'v'"),
        in_shape("{type: rectangle, material: white, corner: [0, 0, 0], u: [1, 0, 0], v: @[2, 0, 0]}", "without area"),
        in_shape("{type: rectangle, material: white, corner: [0, 0, 0], u: [1, 0, 0], v: @[0, 0, 0]}", "without area"),
        in_shape("@{type: rectangle, material: white, corner: [-1e11, 0, 0], u: [0.6, 0, 0], v: [0, 0, 0.6]}",
                 "without area, expected one that can be seen: of coordinates about 7 digits are kept"),
        in_shape("{type: box, material: white, min: [0, 0, 0], max: @[1, 0, 1]}",
                 "found y from 0 to 0, expected min below max"),
        in_shape("@{type: mesh, material: white}", "a mesh without 'file'"),
        in_shape("{type: mesh, material: white, file: @no.ply}", "no such file"),
        in_shape("{type: mesh, material: white, file: @.}", "not a file"),
        in_shape("{type: mesh, material: white, file: @scene.yaml}", "extension '.yaml'"),
        in_shape("{type: mesh, material: white, file: @empty.obj}", "empty.obj: found"),
        in_shape("{type: mesh, material: white, file: @points.obj}", "points.obj: found"),
        in_shape("{type: mesh, material: white, file: @junk.ply}", "junk.ply: found the format 'nonsense'"),
        in_shape("{type: mesh, material: white, file: @endless.ply}", "endless.ply: found a broken mesh (its header"),
        in_shape("{type: mesh, material: white, file: @huge.ply}",
                 "found 'element vertex 4000000000' in a file of 58 bytes"),
        in_shape("{type: mesh, material: white, file: @cornerless.ply}", "cornerless.ply: found a face with 0 corners"),
        in_shape("{type: mesh, material: white, file: @nan.ply}", "nan.ply: found the coordinate nan"),
        in_shape("{type: mesh, material: white, file: @index.ply}",
                 "index.ply: found the vertex index 7, expected one below 3"),
        // Transforms.
        in_transform("@3", "a list of transforms"),
        in_transform("[@{scale: 1, rotate: [1, 0, 0, 1]}]", "found 2 transforms in one map"),
        in_transform("@{}", "found 0 transforms in one map"),
        in_transform("{@shear: 1}", "unknown key 'shear'"),
        in_transform("[{scale: @0}]", "singular transform"),
        in_transform("[{scale: @[1, 0, 1]}]", "singular transform"),
        in_transform("[{rotate: @[90, 0, 0, 0]}]", "rotation axis"),
        in_transform("[{rotate: @[90, 1]}]", "a list of 4 numbers"),
        in_transform("[{matrix: @[1,0,0,0, 2,0,0,0, 0,0,1,0, 0,0,0,1]}]", "singular matrix"),
        in_transform("[{matrix: [1,0,0,0, 0,1,0,0, 0,0,1,0, @0,0,1,1]}]", "projective"),
        in_shape("@{type: box, material: white, transform: [{scale: 1e9}, {scale: 1e9}]}", "too large or too far"),
        in_shape("@{type: box, material: white, transform: [{scale: 1e-12}, {scale: 1e-12}, {translate: [1, 1, 1]}]}",
                 "without area"),
        // Emission and emitters.
        in_emission("@5",
                    "expected a map that describes an emission, with keys of radiance, power, two_sided, texture"),
        {"film: {resolution: [4, 4]}\n@lights: []\n", "did you mean 'emitters'?"},
        in_emission("{power: @60W}", "found the value '60W', expected an amount of light: a number alone"),
        in_emission("@{two_sided: true}", "neither of 'radiance' and 'power'"),
        in_emission("@{radiance: 1, power: 1}", "both of 'radiance' and 'power'"),
        in_emission("{radiance: @-1}", "an amount of light"),
        in_emission("{radiance: 1, two_sided: @1}", "expected true or false"),
        in_emission("{radiance: [1, @x, 1]}", "found the value 'x'"),
        in_section("emitters: [@{type: point, intensity: 1}]", "without 'position'"),
        in_section("emitters: [@{type: point, position: [0, 0, 0]}]", "neither of 'intensity' and 'power'"),
        in_section("emitters: [{type: @spott, position: [0, 0, 0]}]",
                   "expected one of distant, environment, goniometric, point, projection, spot; did you mean 'spot'?"),
        in_section("emitters: [@{type: spot, position: [0, 0, 0], power: 1}]", "neither of 'to' and 'direction'"),
        in_section("emitters: [{type: spot, position: [0, 0, 0], to: [0, 1, 0], angle: 20, falloff: @21, power: 1}]",
                   "an angle up to 'angle'"),
        in_section("emitters: [{type: distant, direction: @[0, 0, 0], irradiance: 1}]", "[0, 0, 0]"),
        in_section("emitters: [@{type: goniometric, position: [0, 0, 0], intensity: 1}]", "without 'image'"),
        in_section("emitters: [{type: projection, position: [0, 0, 0], intensity: 1, image: a.exr, fov: @180}]",
                   "a field of view"),
        in_material("{type: diffuse, reflectance: {type: checkerboard, a: 0, b: 1, mapping: @conical}}",
                    "expected one of uv, planar, spherical, cylindrical"),
        in_material("{type: diffuse, reflectance: {type: checkerboard, a: 0, b: 1, transform: @{scale: 2}}}",
                    "'transform' without 'mapping'"),
        in_material("{type: diffuse, reflectance: {type: checkerboard, a: 0, b: 1, dimension: 3, repeat: @[2, 2]}}",
                    "'repeat' beside 3 dimensions"),
        in_material("{type: diffuse, reflectance: {type: direction_mix, a: 0, b: 1, direction: @[0, 0, 0]}}",
                    "[0, 0, 0]"),
        in_material("{type: diffuse, reflectance: {type: marble, octaves: @0}}", "a number of octaves"),
        in_camera("{from: [0, 0, 4], to: [0, 0, 0], orthographic: 2, fov: @40}", "'fov' beside 'orthographic'"),
        in_camera("{from: [0, 0, 4], to: [0, 0, 0], orthographic: @0}", "a length"),
        in_section("emitters: [@{type: environment, layout: lat_long}]", "'layout' without 'image'"),
        in_section("emitters: [{type: environment, image: @nowhere.exr}]", "nowhere.exr"),
        in_section("emitters: [{type: point, position: [0, 0, 0], power: @-3}]", "an amount of light"),
        // Groups.
        in_shape("@{type: group}", "a group without 'shapes'"),
        in_shape("{type: group, shapes: [@{type: box}]}", "without 'material'"),
        in_shape("{type: instance, group: @chair}", "unknown group 'chair', expected none"),
        in_section("groups: {a: @3}", "a list of shapes"),
        in_section("groups:\n  a: [{type: instance, group: b}]\n  b: [{type: instance, group: @a}]",
                   "the group 'a' within itself"),
        in_section("groups: {a: [{type: sphere, material: @red}]}", "unknown material 'red', expected none"),
        // Includes.
        {"include: @3d/none.yaml\n", "none.yaml: found no such file"},
        {"include: [@scene.yaml]\n", "including itself"},
        {"include: @{}\n", "the path of a scene file"},
        {"include: @.\n", "found a directory"},
        {"include: white.yaml\nmaterials: {@white: {type: mirror}}\n",
         "the material 'white' again, expected another name (first at"},
        // Settings.
        in_section("render: @fast", "a map from names to settings"),
        in_section("render: {@sppp: 4}", "unknown setting 'sppp'"),
        in_section("render: {@sppp: 4}", "did you mean 'spp'?"),
        in_section("render: {spp: @0}", "found '0' for 'spp', expected a whole number from 1 to 16777216"),
        in_section("render: {spp: @1.5}", "expected a whole number"),
        in_section("render: {spp: @[4]}", "found a list of 1"),
        in_section("user_paths: @no.yaml", "no.yaml: found no such file, expected a file of user paths"),
        in_section("materials: {a: {type: diffuse, reflectance: {type: image, file: @junk.ply}}}",
                   "junk.ply: found no image that can be read (OpenImageIO "),
        in_section("emitters: [{type: environment, image: @wide.pfm, layout: octahedral}]",
                   "found an octahedral picture of 2 x 1 pixels for an environment, expected a square"),
        in_section(
            "render: {method: @mpss}",
            "expected one of auto, path, bdpt, ipm, mmlt, mps, cps, mlt, pssmlt, rjmlt, pm; did you mean 'mps'?"),
        in_section("render: {bidirectional.weight: @1.5}", "expected a number from 0 to 1"),
        in_section("render: {bidirectional.weight: @nan}", "expected a number from 0 to 1"),
    };
}

/// Takes the marker out of `text`. @returns ":line:column: " of where it stood.
std::string take_marker(std::string& text) {
    const auto at = text.find('@');
    const auto line_start = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
    text.erase(at, 1);
    return ":" + std::to_string(line) + ":" + std::to_string(at - line_start + 1) + ": ";
}

const std::string kPlyHead =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

class SceneYamlErrors : public testing::Test {
  protected:
    void SetUp() override {
        directory.write("empty.obj", "");
        directory.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
        directory.write("junk.ply", "ply\nformat nonsense\n\x01\x02\x03");
        directory.write("endless.ply", "ply\nformat ascii 1.0\nelement vertex 3\n0 0 0\n1 0 0\n");
        directory.write("huge.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nend_header\n");
        directory.write("cornerless.ply", kPlyHead + "0 0 0\n1 0 0\n0 1 0\n0\n");
        directory.write("nan.ply", kPlyHead + "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n");
        directory.write("index.ply", kPlyHead + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
        directory.write("wide.pfm", std::string("PF\n2 1\n-1.0\n") + std::string(2 * 3 * sizeof(float), '\0'));
        directory.write("white.yaml", "materials: {white: {type: diffuse}}\n");
    }
    ScratchDirectory directory;
};

TEST_F(SceneYamlErrors, EveryMistakeIsReportedWhereItStands) {
    const auto all = mistakes();
    ASSERT_GE(all.size(), 60u);
    for (Mistake mistake : all) {
        const std::string where = take_marker(mistake.text);
        const std::string path = directory.write("scene.yaml", mistake.text);
        try {
            load_scene(path);
            ADD_FAILURE() << "accepted:\n" << mistake.text.substr(0, 1000);
        } catch (const InputError& e) {
            const std::string what = e.what();
            const std::string start = what.substr(0, path.size() + where.size());
            EXPECT_EQ(start, path + where) << what << "\n" << mistake.text.substr(0, 1000);
            EXPECT_NE(what.find(mistake.message), std::string::npos) << what << "\nlacks: " << mistake.message;
        }
    }
}

TEST_F(SceneYamlErrors, MissingFileIsReportedByName) {
    try {
        load_scene(directory.path("none.yaml"));
        FAIL();
    } catch (const InputError& e) {
        EXPECT_EQ(std::string(e.what()), directory.path("none.yaml") + ": found no such file, expected a scene file");
    }
    EXPECT_THROW(load_scene(directory.path("")), InputError);
}

TEST_F(SceneYamlErrors, MistakeInAnIncludedFileIsReportedThere) {
    directory.write("bad.yaml", "film: {}\nmaterials: {a: {type: 3}}\n");
    try {
        load_scene(directory.write("scene.yaml", "include: bad.yaml\n" + kCamera + kShapes));
        FAIL();
    } catch (const InputError& e) {
        EXPECT_EQ(std::string(e.what()).rfind(directory.path("bad.yaml") + ":2:23: ", 0), 0u) << e.what();
    }
}

TEST_F(SceneYamlErrors, DeepYamlAndLongLinesDoNotExhaustTheStack) {
    for (const std::string unit : {"[", "{a: ", "- ", "? ", "&a [", "!t [", "\"", "a: b: "})
        EXPECT_THROW(load_scene(directory.write("scene.yaml", repeat(unit, 20'000))), InputError) << unit;
}

TEST_F(SceneYamlErrors, CutOffFilesNeverCrash) {
    const std::string whole =
        kCamera + "materials: {white: {type: diffuse, reflectance: [.5, .6, .7]}}\nshapes:\n" +
        "  - {type: box, min: [0, 0, 0], max: [1, 2, 3], material: white, transform: [{scale: 2}]}\n";
    for (std::size_t n = 0; n < whole.size(); ++n) {
        try {
            load_scene(directory.write("scene.yaml", whole.substr(0, n)));
            EXPECT_GE(n, whole.size() - 1);
        } catch (const InputError&) {
        }
    }
}

} // namespace
} // namespace keyhole
