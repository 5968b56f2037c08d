// One run shows all mistakes of a scene, each once, and none that only follow from others.
#include "core/error.h"
#include "scene/load/load.h"
#include "support/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SceneMistakes : public testing::Test {
  protected:
    /// What is wrong with a file, without its path.
    std::vector<std::string> lines(const std::string& name, const std::string& text) {
        const std::string path = scratch.write(name, text);
        try {
            load(path);
        } catch (const InputErrors& e) {
            std::vector<std::string> found;
            for (const std::string& line : e.lines())
                found.push_back(line.rfind(path, 0) == 0 ? line.substr(path.size() + 1) : line);
            return found;
        }
        return {};
    }
    ScratchDirectory scratch;
};

TEST_F(SceneMistakes, OfAPbrtFileAreAllShown) {
    scratch.write("bad.ply", "solid");
    const auto found = lines("s.pbrt", "Film \"rgb\" \"integer xresolution\" 0\n"
                                       "Sampler \"zsobol\" \"integer pixelsamples\" -1\n"
                                       "Scale 1 2\n"
                                       "WorldBegin\n"
                                       "LightSource \"pint\"\n"
                                       "Shape \"sphere\" \"float radius\" -1\n"
                                       "Shape \"sphere\" \"flaot radius\" 1 \"float zmin\" 0\n"
                                       "Material \"diffuse\" \"rgb reflectance\" [ 1 1\n"
                                       "Shape \"plymesh\" \"string filename\" \"bad.ply\"\n"
                                       "Shape \"plymesh\" \"string filename\" \"none.ply\"\n");
    EXPECT_THAT(found, ElementsAre(HasSubstr("4:1: Scale: found 'WorldBegin'"), HasSubstr("1:"), HasSubstr("2:"),
                                   HasSubstr("5:1: "), HasSubstr("6:16: "), HasSubstr("7:16: "),
                                   HasSubstr("9:1: Material \"diffuse\": found 'Shape'"),
                                   HasSubstr("9:1: Shape \"plymesh\": "), HasSubstr("10:1: Shape \"plymesh\": ")));
}

TEST_F(SceneMistakes, ThatFollowFromOthersAreNotShown) {
    const std::string world = "WorldBegin\n";
    EXPECT_THAT(lines("a.pbrt", world + "MakeNamedMaterial \"m\" \"string type\" \"difuse\"\n"
                                        "NamedMaterial \"m\" Shape \"sphere\"\n"),
                ElementsAre(HasSubstr("2:1: ")));
    EXPECT_THAT(lines("b.pbrt", world + "Textur \"t\" \"float\" \"constant\"\n"
                                        "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"\n"),
                ElementsAre(HasSubstr("2:1: found 'Textur'")));
    EXPECT_THAT(lines("c.pbrt", world + "AttributeBegin\nAttributeEnd\nAttributeEnd\nShape \"spere\"\n"),
                ElementsAre(HasSubstr("4:1: ")))
        << "where blocks don't match reading ends";
    EXPECT_THAT(lines("d.pbrt", "Shape \"sphere\"\nShape \"sphere\"\n"), ElementsAre(HasSubstr("1:1: ")));
    EXPECT_THAT(lines("e.yaml", "include: none.yaml\nshapes: [{type: sphere, material: wood}]\n"),
                ElementsAre(HasSubstr("1:10: ")));
}

TEST_F(SceneMistakes, OfUnknownNamesAreShownOnceForEach) {
    EXPECT_THAT(lines("s.pbrt", "WorldBegin NamedMaterial \"a\"\nShape \"sphere\"\nShape \"sphere\"\n"
                                "NamedMaterial \"b\" Shape \"disk\"\n"),
                ElementsAre(HasSubstr("1:12: NamedMaterial"), HasSubstr("4:1: NamedMaterial")));
}

TEST_F(SceneMistakes, OfAYamlFileAreAllShown) {
    const auto found = lines("s.yaml", "film: {resolution: [0, 4]}\n"
                                       "camra: {}\n"
                                       "materials: {a: {type: difuse}, b: {type: glass, ior: 0}}\n"
                                       "groups: {g: [{type: sphere, radius: -1, material: {type: mirror}}]}\n"
                                       "shapes:\n"
                                       "  - {type: sphere, radius: 0, material: b}\n"
                                       "  - {type: instance, group: g}\n"
                                       "  - {type: instance, group: g}\n"
                                       "  - {type: box, material: b, min: 3}\n"
                                       "emitters: [{type: point}, {type: spto}]\n"
                                       "render: {sppp: 1, spp: 0}\n");
    EXPECT_THAT(found, ElementsAre(HasSubstr("2:1: "), HasSubstr("1:21: "), HasSubstr("3:23: "), HasSubstr("3:54: "),
                                   HasSubstr("6:28: "), HasSubstr("4:37: "), HasSubstr("9:35: "), HasSubstr("10:12: "),
                                   HasSubstr("10:34: "), HasSubstr("11:10: "), HasSubstr("11:24: ")));
}

TEST_F(SceneMistakes, InIncludedPbrtFilesAreShownWithBothPlaces) {
    scratch.write("part.pbrt", "WorldBegin Shape \"spere\" Shape \"dsik\"\n");
    const auto found = lines("s.yaml", "include: part.pbrt\n");
    ASSERT_EQ(found.size(), 2u);
    for (const std::string& line : found) EXPECT_THAT(line, HasSubstr("1:10: " + scratch.path("part.pbrt") + ":1:"));
}

TEST_F(SceneMistakes, BeyondTwentyAreCounted) {
    std::string text = "WorldBegin\n";
    for (int i = 0; i < 25; ++i) text += "Shape \"sphere\" \"float radius\" -1\n";
    const auto found = lines("s.pbrt", text);
    ASSERT_EQ(found.size(), 21u);
    EXPECT_EQ(found.back(), "and 5 more");
    EXPECT_THAT(found[19], HasSubstr("21:16: "));
}

TEST_F(Program, PrintsALineForEachMistake) {
    scratch.write("bad.pbrt", "WorldBegin\nShape \"spere\"\nShape \"dsik\"\n");
    EXPECT_EQ(run("render bad.pbrt"), 2);
    EXPECT_THAT(read("err"), testing::MatchesRegex("keyhole: bad.pbrt:2:1: [^\n]*\nkeyhole: bad.pbrt:3:1: [^\n]*\n"));
}

} // namespace
} // namespace keyhole
