// Files that a command must not write over: what it reads, what it writes besides, and the work of days.
#include "support/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace keyhole;
using testing::HasSubstr;

namespace {

using Files = Program;

} // namespace

TEST_F(Files, OutputsNeverReplaceInputsOrEachOther) {
    scratch.write("part.yaml", "materials: {red: {type: diffuse, reflectance: [0.8, 0.1, 0.1]}}\n");
    scratch.write("paths.yaml", "paths: [{points: [[0, 3, 0], [0, 1, 0]]}]\n");
    scratch.write("whole.yaml", "include: part.yaml\nuser_paths: paths.yaml\n" + std::string(kScene));
    std::filesystem::create_symlink("whole.yaml", scratch.path("link.yaml"));
    ASSERT_EQ(run("render scene.yaml -q --method ipm -D light_paths=2k --save-map map.photons -o b.exr"), 0);
    ASSERT_EQ(run("render scene.yaml -q --seed 2 -o c.exr"), 0);
    for (const char* line :
         {"render whole.yaml -o a.exr --stats whole.yaml", "render whole.yaml -o a.exr --stats link.yaml",
          "render whole.yaml -o a.exr --stats ./part.yaml", "render whole.yaml -o a.exr --stats paths.yaml",
          "render whole.yaml -o a.exr --png whole.yaml",
          "render whole.yaml -o a.exr --method ipm --save-map whole.yaml",
          "render whole.yaml -o a.exr --method ipm --save-map a.exr",
          "render whole.yaml -o a.exr --method ipm --save-map a.png",
          "render scene.yaml -o a.exr --load-map map.photons --stats map.photons",
          "render scene.yaml -o a.exr --method ipm --user-paths paths.yaml --stats paths.yaml",
          "render scene.yaml -o a.exr --stats a.checkpoint.exr --checkpoint 1",
          "render scene.yaml -o a.exr --stats a.exr", "paths suggest scene.yaml -n 1 -o scene.yaml",
          "paths show scene.yaml paths.yaml -o paths.yaml", "inspect scene.yaml -o scene.yaml",
          "inspect scene.yaml -o a.html --save-map scene.yaml", "merge b.exr c.exr --no-png -o c.exr"}) {
        const std::array before{read("whole.yaml"), read("part.yaml"),   read("paths.yaml"),
                                read("scene.yaml"), read("map.photons"), read("c.exr")};
        EXPECT_EQ(run(line), 2) << line;
        EXPECT_THAT(read("err"), HasSubstr("expected")) << line;
        EXPECT_EQ(before, (std::array{read("whole.yaml"), read("part.yaml"), read("paths.yaml"), read("scene.yaml"),
                                      read("map.photons"), read("c.exr")}))
            << line;
        EXPECT_FALSE(exists("a.exr") || exists("a.html")) << line;
    }
    EXPECT_EQ(run("render scene.yaml -q -o a.exr --png /dev/null --stats /dev/null"), 0) << read("err");
}

/// Before a scene is loaded, which may take minutes.
TEST_F(Files, PhotonMapsThatAreNoneAreRefusedAtOnce) {
    scratch.write("short.photons", "KHPH");
    for (const char* file : {"none.photons", "short.photons", "scene.yaml"}) {
        EXPECT_EQ(run("render none.yaml --method ipm --load-map " + std::string(file)), 2) << file;
        EXPECT_THAT(read("err"), HasSubstr(file)) << file;
    }
    EXPECT_EQ(run("info none.glb"), 2);
    EXPECT_THAT(read("err"), HasSubstr("none.glb: found no such file, expected a scene file"));
}

TEST_F(Files, OutputsReplaceNothingThatASceneIsReadFrom) {
    scratch.write("red.ppm", "P3 1 1 255 255 0 0\n");
    scratch.write("sky.ppm", "P3 2 1 255 9 9 9 9 9 9\n");
    scratch.write("roof.obj", "mtllib roof.mtl\nv -1 2 -1\nv 1 2 -1\nv 0 2 1\nf 1 2 3\n");
    scratch.write("roof.mtl", "newmtl a\n");
    std::filesystem::copy_file(KEYHOLE_SOURCE_DIR "/tests/data/tent.ply", scratch.path("tent.ply"));
    scratch.write("all.yaml", R"(
film: {resolution: [24, 16]}
camera: {from: [0, 0, 3], to: [0, 0, 0]}
materials: {white: {type: diffuse, reflectance: {type: image, file: red.ppm}}}
shapes:
  - {type: sphere, material: white}
  - {type: mesh, file: roof.obj, material: white}
emitters:
  - {type: environment, image: sky.ppm}
)");
    scratch.write("part.pbrt", "Shape \"plymesh\" \"string filename\" \"tent.ply\"\n");
    scratch.write("all.pbrt", "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\n"
                              "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\nInclude \"part.pbrt\"\n");
    for (const auto& [scene, files] : std::initializer_list<std::pair<std::string, std::vector<std::string>>>{
             {"all.yaml", {"red.ppm", "sky.ppm", "roof.obj"}}, {"all.pbrt", {"part.pbrt", "tent.ply"}}}) {
        for (const std::string& file : files)
            for (const std::string& line :
                 {"render " + scene + " -o a.exr --spp 1 --stats " + file, "inspect " + scene + " -o " + file,
                  "paths suggest " + scene + " -o " + file}) {
                const std::string before = read(file);
                EXPECT_EQ(run(line), 2) << line;
                EXPECT_THAT(read("err"), HasSubstr("as a file of the scene, which is read")) << line;
                EXPECT_EQ(read(file), before) << line;
            }
        EXPECT_EQ(run("render " + scene + " -q -o a.exr --spp 1 --stats other.json"), 0) << read("err");
    }
}

TEST_F(Files, ACheckpointIsReplacedByNothingButItsOwnRender) {
    const std::string render = "render scene.yaml -q --no-png -o a.exr --passes 2 --checkpoint 1000";
    ASSERT_EQ(run(render), 0) << read("err");
    const std::string kept = read("a.checkpoint.exr");
    EXPECT_EQ(run(render), 2);
    EXPECT_THAT(read("err"), HasSubstr("a.checkpoint.exr: found a checkpoint"));
    EXPECT_THAT(read("err"), HasSubstr("--resume"));
    EXPECT_EQ(read("a.checkpoint.exr"), kept);
    EXPECT_EQ(run(render + " --resume"), 0) << read("err");
    std::filesystem::rename(scratch.path("a.checkpoint.exr"), scratch.path("a.checkpoint.5.exr"));
    EXPECT_EQ(run(render), 2) << "one of several processes";
    EXPECT_TRUE(exists("a.checkpoint.5.exr"));
}

TEST_F(Files, ANameThatIsTooLongIsAMistakeOfTheUser) {
    EXPECT_EQ(run("render scene.yaml -q --no-png --checkpoint 1 -o " + std::string(245, 'x') + ".exr"), 2);
    EXPECT_THAT(read("err"), HasSubstr("File name too long"));
}
