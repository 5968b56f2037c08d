// A proposal and a method, each added by one file beside this one and one line of its table (see CMakeLists.txt), are
// part of the program: of its help, its settings, its renders and their statistics. The invariance test, which is
// linked to this one, takes the proposal from the table, too.
#include "support/program.h"

#include <gmock/gmock.h>

namespace keyhole {
namespace {

class Extension : public Program {
  protected:
    int run(const std::string& arguments) { return wait(start_line(KEYHOLE_EXTENDED " " + arguments)); }
};

TEST_F(Extension, IsInTheHelp) {
    EXPECT_EQ(run("render --help"), 0) << read("err");
    EXPECT_THAT(read("out"),
                testing::AllOf(testing::HasSubstr("the method of a test"), testing::HasSubstr("extension.weight=0.1"),
                               testing::HasSubstr("relative frequency of the proposals of a test")));
}

TEST_F(Extension, IsInRendersAndTheirStatistics) {
    ASSERT_EQ(run("render " KEYHOLE_SOURCE_DIR "/scenes/box.yaml --resolution 16x12 -q -o a.exr -D method=extension "
                  "-D mutations=20000 -D brightness_samples=2000 "
                  "-D extension.weight=0.9 --stats stats.json"),
              0)
        << read("err");
    const std::string stats = read("stats.json");
    EXPECT_THAT(stats, testing::ContainsRegex("\"method\": *\"extension\""));
    EXPECT_THAT(stats, testing::ContainsRegex("\"name\": *\"extension\"")) << "the proposal's line of the table";
}

TEST_F(Extension, HasItsRange) {
    EXPECT_NE(run("render scene.yaml -q -D extension.weight=2"), 0);
    EXPECT_THAT(read("err"), testing::HasSubstr("extension.weight"));
}

} // namespace
} // namespace keyhole
