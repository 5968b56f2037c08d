// The filter at the end, from outside: which files it changes.
#include "film/files/exr.h"
#include "support/program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace keyhole;

TEST_F(Program, GrainIsFilteredInTheFilesThatAreNamed) {
    const std::string common = " --resolution 40x30 --spp 8 --seed 3 -q";
    ASSERT_EQ(run("render scene.yaml -o plain.exr --denoise off" + common), 0) << read("err");
    ASSERT_EQ(run("render scene.yaml -o usual.exr -t 1" + common), 0) << read("err");
    ASSERT_EQ(run("render scene.yaml -o all.exr -t 3 --denoise exr --stats s.json" + common), 0) << read("err");
    const Picture plain = read_exr(scratch.path("plain.exr")), usual = read_exr(scratch.path("usual.exr")),
                  all = read_exr(scratch.path("all.exr"));
    EXPECT_EQ(usual.layers.at("beauty").data, plain.layers.at("beauty").data);
    EXPECT_FALSE(usual.layers.contains("unfiltered"));
    EXPECT_NE(read("usual.png"), read("plain.png"));
    EXPECT_EQ(read("usual.png"), read("all.png"));
    EXPECT_EQ(all.layers.at("unfiltered").data, plain.layers.at("beauty").data);
    EXPECT_NE(all.layers.at("beauty").data, plain.layers.at("beauty").data);
    EXPECT_EQ(all.layers.at("indirect").data, plain.layers.at("indirect").data);
    const auto stats = nlohmann::json::parse(read("s.json"));
    EXPECT_EQ(stats["stages"].back()["name"], "denoising");
    EXPECT_GT(stats["values"]["noise of samples"], 0);
}

TEST_F(Program, NoiseIsWrittenWhereItIsAskedFor) {
    ASSERT_EQ(run("render scene.yaml -o a.exr -D noise_layers=true --no-png -q"), 0) << read("err");
    const Picture p = read_exr(scratch.path("a.exr"));
    for (const char* layer : {"noise.direct", "noise.indirect", "noise.caustic", "noise.albedo", "noise.normal"})
        EXPECT_EQ(p.layers.at(layer).channels, 3) << layer;
    EXPECT_EQ(p.layers.at("noise.depth").channels, 1);
}

TEST_F(Program, ADraftIsFilteredUnlessSomebodySaysOtherwise) {
    ASSERT_EQ(run("render scene.yaml -o a.exr --quality draft --no-png -q"), 0) << read("err");
    EXPECT_TRUE(read_exr(scratch.path("a.exr")).layers.contains("unfiltered"));
    ASSERT_EQ(run("render scene.yaml -o a.exr --quality draft --denoise off --no-png -q"), 0) << read("err");
    EXPECT_FALSE(read_exr(scratch.path("a.exr")).layers.contains("unfiltered"));
}

// What is known of noise goes through shares and `merge`, too.
TEST_F(Program, SharesThatAreJoinedAreFilteredAsTheWhole) {
    const std::string common = "render scene.yaml --method bdpt --spp 3 --passes 2 -q ";
    ASSERT_EQ(run(common + "-o whole.exr"), 0) << read("err");
    ASSERT_EQ(run(common + "-o a.exr --pass-range 0:1"), 0) << read("err");
    ASSERT_EQ(run(common + "-o b.exr --pass-range 1:2"), 0) << read("err");
    ASSERT_EQ(run("merge a.exr b.exr -o joined.exr"), 0) << read("err");
    EXPECT_EQ(read("joined.png"), read("whole.png"));
    EXPECT_FALSE(read_exr(scratch.path("joined.exr")).layers.contains("noise.direct"));
}

// What is joined is what was rendered; the mean is filtered once, at the end.
TEST_F(Program, FilteredPicturesAreJoinedAsTheyWereRendered) {
    const std::string common = "render scene.yaml --spp 8 -D noise_layers=true --no-png -q ";
    for (const char* seed : {"1", "2"}) {
        ASSERT_EQ(run(common + "--seed " + seed + " --denoise off -o plain" + seed + ".exr"), 0) << read("err");
        ASSERT_EQ(run(common + "--seed " + seed + " --denoise exr -o smooth" + seed + ".exr"), 0) << read("err");
    }
    ASSERT_EQ(run("merge plain1.exr plain2.exr -o plain.exr --no-png"), 0) << read("err");
    ASSERT_EQ(run("merge smooth1.exr smooth2.exr -o smooth.exr --no-png"), 0) << read("err");
    const Picture plain = read_exr(scratch.path("plain.exr")), smooth = read_exr(scratch.path("smooth.exr"));
    EXPECT_EQ(smooth.layers.at("unfiltered").data, plain.layers.at("beauty").data);
    EXPECT_NE(smooth.layers.at("beauty").data, plain.layers.at("beauty").data);
    EXPECT_TRUE(smooth.layers.contains("noise.direct"));
}
