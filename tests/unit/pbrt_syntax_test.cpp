// Tokens, directives and blocks of pbrt's format, and the mistakes in them.
#include "core/error.h"
#include "scene/load/pbrt/syntax/directive.h"
#include "support/pbrt_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace keyhole {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<pbrt::Directive> parse(const std::string& text) {
    pbrt::DirectiveReader reader(text, "t.pbrt");
    std::vector<pbrt::Directive> directives;
    while (auto d = reader.next()) directives.push_back(*d);
    return directives;
}

std::string error_of(const std::string& text) {
    try {
        parse(text);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(PbrtSyntax, ParametersKeepTypeNameAndValues) {
    const auto d = parse("# a comment\nShape \"sphere\" \"float radius\" [ +.5e1 ] # another\n"
                         "\t\"bool flag\" true \"string s\" [\"a\\\"b\" \"c#d\"] \"point3 P\"[1 2 3 -4 5 6]\"spectrum "
                         "k\" \"metal-Cu-k\"");
    ASSERT_EQ(d.size(), 1u);
    EXPECT_EQ(d[0].title(), "Shape \"sphere\"");
    EXPECT_EQ(d[0].position.line, 2);
    const auto& p = d[0].parameters;
    ASSERT_EQ(p.size(), 5u);
    EXPECT_THAT(p[0].numbers, ElementsAre(5));
    EXPECT_TRUE(p[1].bools[0]);
    EXPECT_THAT(p[2].strings, ElementsAre("a\"b", "c#d"));
    EXPECT_THAT(p[3].numbers, ElementsAre(1, 2, 3, -4, 5, 6));
    EXPECT_THAT(p[4].strings, ElementsAre("metal-Cu-k"));
    EXPECT_EQ(p[3].position.line, 3);
}

TEST(PbrtSyntax, MatricesMayHaveBrackets) {
    EXPECT_THAT(parse("Translate [ 1 2 3 ]")[0].numbers, ElementsAre(1, 2, 3));
    EXPECT_EQ(parse("LookAt 0 0 0 0 0 1 0 1 0 Scale 1 1 1").size(), 2u);
}

TEST(PbrtSyntax, OptionsHaveAValueWithOrWithoutAType) {
    for (const char* text :
         {"Option \"disablepixeljitter\" true", "Option \"rendercoordsys\" \"world\"", "Option \"seed\" [ 7 ]",
          "Option \"bool wavefront\" [true]", "Option \"integer seed\" 3"}) {
        const auto directives = parse(std::string(text) + " WorldBegin");
        ASSERT_EQ(directives.size(), 2u) << text;
        EXPECT_EQ(directives[1].name, "WorldBegin");
    }
    EXPECT_THAT(error_of("Option \"seed\" WorldBegin"), HasSubstr("expected a value"));
    EXPECT_THAT(error_of("Option \"seed\" [ 1 2 ]"), HasSubstr("expected ']'"));
    EXPECT_THAT(error_of("Option \"seed\""), HasSubstr("expected a value"));
}

TEST(PbrtSyntax, AByteOrderMarkIsPassedOver) { EXPECT_EQ(parse("\xEF\xBB\xBFWorldBegin").at(0).name, "WorldBegin"); }

TEST(PbrtSyntax, OlderNamesOfTypesAreTranslated) {
    const auto p =
        parse("Material \"matte\" \"color Kd\" [1 1 1] \"bool b\" \"false\" \"point p\" [1 2 3]")[0].parameters;
    EXPECT_EQ(p[0].type, "rgb");
    EXPECT_FALSE(p[1].bools[0]);
    EXPECT_EQ(p[2].type, "point3");
}

TEST(PbrtSyntax, MistakesAreNamedWhereTheyStand) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"Shpe \"sphere\"", "t.pbrt:1:1: found 'Shpe', expected a directive; did you mean 'Shape'?"},
        {"\n \"Shape\"", "t.pbrt:2:2: found the string \"Shape\", expected a directive"},
        {"Translate 1 2", "found the end of the file, expected a finite number"},
        {"Translate 1 2 nan", "t.pbrt:1:15: Translate: found 'nan', expected a finite number"},
        {"Scale 1 2 inf", "found 'inf'"},
        {"Scale 1 2 1e999", "found '1e999'"},
        {"Scale 1 2 0x10", "found '0x10'"},
        {"Transform [ 1 0 0 0 0 1 ]", "found ']', expected a finite number"},
        {"Translate [ 1 2 3 4 ]", "found '4' after 3 numbers, expected ']'"},
        {"Shape", "found the end of the file, expected a name in quotes"},
        {"Shape sphere", "t.pbrt:1:7: Shape: found 'sphere', expected a name in quotes"},
        {"Shape \"sphere", "found the string \"sphere\" without an end"},
        {"Shape \"sphere\n\"", "without an end"},
        {"Shape \"sphere\" \"float\" 1", "expected the type and the name of a parameter"},
        {"Shape \"sphere\" \"\" 1", "expected the type and the name of a parameter"},
        {"Shape \"sphere\" \"flaot radius\" 1", "found the type 'flaot', expected one of"},
        {"Shape \"sphere\" \"float radius\"", "found the end of the file as 'float radius', expected a finite number"},
        {"Shape \"sphere\" \"float radius\" [ ]", "found no value of 'radius'"},
        {"Shape \"sphere\" \"float radius\" [ 1", "found the end of the file as 'float radius'"},
        {"Shape \"sphere\" \"float radius\" \"1\"",
         "found the string \"1\" as 'float radius', expected a finite number"},
        {"Shape \"sphere\" \"float radius\" [ [ 1 ] ]", "found '[' as 'float radius'"},
        {"Shape \"sphere\" \"string s\" 1", "expected a string in quotes"},
        {"Shape \"sphere\" \"bool b\" 1", "expected true or false"},
        {"Shape \"m\" \"point3 P\" [ 1 2 ]", "found 2 numbers in 'point3 P', expected a multiple of 3"},
        {"Shape \"m\" \"integer i\" [ 1.5 ]", "expected a whole number"},
        {"Shape \"m\" \"integer i\" [ 99999999999 ]", "expected a whole number"},
        {std::string("\0\1\2ELF", 6), "found the byte 0x00, expected text"},
        {"Shape \x7f", "found the byte 0x7f, expected text"},
    };
    for (const auto& [text, message] : cases) EXPECT_THAT(error_of(text), HasSubstr(message)) << text;
}

TEST(PbrtSyntax, OfAParameterGivenTwiceTheLastCounts) {
    const PbrtScene s("Shape \"sphere\" \"float radius\" 1 \"float radius\" 2 \"float radius\" 3");
    EXPECT_EQ(s.sphere().radius, 3);
    EXPECT_THAT(s.warnings,
                ElementsAre(HasSubstr("scene.pbrt:4:16: Shape \"sphere\": 'radius' is given again: the last "
                                      "one counts")));
    const auto d = parse("Shape \"m\" \"float r\" 1 \"integer n\" 5 \"integer r\" 2");
    ASSERT_EQ(d[0].parameters.size(), 2u);
    EXPECT_EQ(d[0].parameters[0].type, "integer") << "of another type, too";
}

std::string load_error(const std::string& text) {
    const ScratchDirectory directory;
    try {
        load_pbrt(directory.write("s.pbrt", text), nullptr);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

TEST(PbrtSyntax, BlocksMustMatch) {
    const std::string world = "WorldBegin\n" + kPbrtTriangle;
    EXPECT_THAT(load_error(world + "AttributeEnd"),
                HasSubstr("s.pbrt:3:1: AttributeEnd: found it without AttributeBegin"));
    EXPECT_THAT(load_error(world + "AttributeBegin\nTransformEnd"),
                HasSubstr("found it in the block of AttributeBegin"));
    EXPECT_THAT(load_error(world + "AttributeBegin"),
                HasSubstr("s.pbrt:3:1: AttributeBegin: found no end of the block"));
    EXPECT_THAT(load_error(world + "ObjectBegin \"a\"\nObjectBegin \"b\""),
                HasSubstr("found an object within an object"));
    EXPECT_THAT(load_error(world + "ObjectInstance \"a\""), HasSubstr("found the unknown object 'a'"));
    EXPECT_THAT(load_error(kPbrtTriangle), HasSubstr("found it before WorldBegin"));
    EXPECT_THAT(load_error(world + "Film \"rgb\""), HasSubstr("found it after WorldBegin"));
    EXPECT_THAT(load_error(""), HasSubstr("found no WorldBegin"));
    EXPECT_THAT(load_error("WorldBegin"), HasSubstr("found an empty scene"));
}

TEST(PbrtSyntax, IncludesAreReadInPlaceAndCyclesRefused) {
    const ScratchDirectory d;
    std::filesystem::create_directory(d.path("sub"));
    d.write("sub/a.pbrt", "Translate 1 0 0\nInclude \"b.pbrt\"\n"); // beside the file that includes it
    d.write("sub/b.pbrt", kPbrtTriangle);
    const auto scene = load_pbrt(d.write("s.pbrt", "WorldBegin Include \"sub/a.pbrt\"\n" + kPbrtTriangle), nullptr);
    ASSERT_EQ(scene.description.shapes.size(), 2u);
    for (const Shape& s : scene.description.shapes) // the transform outlives the include
        EXPECT_EQ(std::get<TriangleMesh>(s.geometry).positions[0], Vec3(1, 0, 0));

    const auto imported = load_pbrt(d.write("i.pbrt", "WorldBegin Import \"sub/a.pbrt\"\n" + kPbrtTriangle), nullptr);
    EXPECT_EQ(std::get<TriangleMesh>(imported.description.shapes[1].geometry).positions[0], Vec3(0, 0, 0));

    const auto error = [&](const std::string& name, const std::string& text) {
        try {
            load_pbrt(d.write(name, text), nullptr);
        } catch (const InputError& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_THAT(error("self.pbrt", "Include \"self.pbrt\""), HasSubstr("self.pbrt:1:1: Include \"self.pbrt\": found"));
    d.write("x.pbrt", "Include \"y.pbrt\"");
    EXPECT_THAT(error("y.pbrt", "\nInclude \"x.pbrt\""), HasSubstr("including itself, expected no cycle"));
    EXPECT_THAT(error("n.pbrt", "Include \"no.pbrt\""), HasSubstr("found no such file"));
    EXPECT_THAT(error("z.pbrt", "\x1f\x8b\x08"), HasSubstr("packed with gzip"));
}

TEST(PbrtSyntax, IncludesThatMultiplyEnd) {
    const ScratchDirectory d;
    for (char c = 'a'; c < 'k'; ++c) {
        std::string text;
        for (int i = 0; i < 10; ++i) text += std::string("Include \"") + static_cast<char>(c + 1) + ".pbrt\"\n";
        d.write(std::string(1, c) + ".pbrt", text);
    }
    d.write("k.pbrt", "Identity");
    EXPECT_THROW(load_pbrt(d.path("a.pbrt"), nullptr), InputError);
}

TEST(PbrtSyntax, EveryTruncationOfASceneIsAnErrorOrAScene) {
    const std::string whole =
        "Film \"rgb\" \"integer xresolution\" [ 8 ]\nCamera \"perspective\" \"float fov\" 40\nWorldBegin\n"
        "AttributeBegin Rotate 30 0 1 0\nMaterial \"conductor\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n" +
        kPbrtTriangle + "AttributeEnd\n";
    for (std::size_t n = 0; n < whole.size(); ++n) {
        const std::string error = load_error(whole.substr(0, n));
        if (n + 1 < whole.size()) {
            EXPECT_NE(error, "") << whole.substr(0, n);
        }
    }
}

} // namespace
} // namespace keyhole
