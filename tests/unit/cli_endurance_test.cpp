// Long renders, from outside: killed and gone on with, done in shares, and not to be trusted.
#include "film/files/exr.h"
#include "film/join.h"
#include "support/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <cstdlib>

using namespace keyhole;
using testing::HasSubstr;

namespace {

class LongRender : public Program {
  protected:
    void expect_same(const std::string& a, const std::string& b) {
        const Picture one = read_exr(scratch.path(a)), other = read_exr(scratch.path(b));
        for (const auto& [name, image] : one.layers) EXPECT_EQ(image.data, other.layers.at(name).data) << name;
    }

    /// Kills the program again and again, mostly soon after it has written a checkpoint, and lets it go on.
    void kill_and_resume(const std::string& render, int kills) {
        const std::string file = scratch.path("a.checkpoint.exr");
        for (int i = 0; i < kills; ++i) {
            std::error_code ignored;
            const auto before = std::filesystem::last_write_time(file, ignored);
            const pid_t pid = start(render + " -o a.exr --checkpoint 0 --resume -t " + std::to_string(i % 4 + 1));
            const bool at_once = i % 5 == 4;
            int status = 0;
            while (!at_once && waitpid(pid, &status, WNOHANG) == 0 &&
                   std::filesystem::last_write_time(file, ignored) == before)
                usleep(1000);
            ASSERT_EQ(status, 0) << read("err");
            usleep(static_cast<useconds_t>(std::rand() % (at_once ? 30'000 : 4000)));
            kill(pid, SIGKILL);
            waitpid(pid, &status, 0);
        }
        EXPECT_FALSE(exists("a.exr")) << "ended before it was killed: the test needs a longer render";
        EXPECT_EQ(run(render + " -o a.exr --checkpoint 1000 --resume"), 0) << read("err");
    }
};

} // namespace

TEST_F(LongRender, KilledFiftyTimesEndsAsIfItHadNotBeen) {
    const std::string render = "render scene.yaml --no-png --spp 40 --passes 60";
    kill_and_resume(render, 50);
    ASSERT_EQ(run(render + " -o b.exr"), 0);
    expect_same("a.exr", "b.exr");
}

class LongRenderBy : public LongRender, public testing::WithParamInterface<const char*> {};

TEST_P(LongRenderBy, ChainsIsGoneOnFromToo) {
    const std::string render = "render scene.yaml --no-png --passes 150 --mutations 5k --method " +
                               std::string(GetParam()) +
                               " -D chains=50 -D brightness_samples=2000 -D importons=2000 -D photon_memory=512KiB";
    const char* kills = std::getenv("KEYHOLE_KILLS"); // more of them, where there is time
    kill_and_resume(render, kills != nullptr ? std::stoi(kills) : 6);
    ASSERT_EQ(run(render + " -o b.exr"), 0);
    expect_same("a.exr", "b.exr");
}

TEST_P(LongRenderBy, ASinglePassIsGoneOnFromToo) {
    const std::string render = "render scene.yaml --no-png --passes 1 --spp 150 --mutations 750k --method " +
                               std::string(GetParam()) +
                               " -D chains=1500 -D chain_groups=150 -D brightness_samples=2000 -D importons=2000 "
                               "-D photon_memory=512KiB";
    kill_and_resume(render, 6);
    ASSERT_EQ(run(render + " -o b.exr"), 0);
    expect_same("a.exr", "b.exr");
}

INSTANTIATE_TEST_SUITE_P(Methods, LongRenderBy, testing::Values("mps", "mlt", "mmlt"),
                         [](const auto& info) { return std::string(info.param); });

TEST_F(LongRender, GoesOnOnlyFromItsOwnCheckpoint) {
    const std::string render = "render scene.yaml -q --no-png --passes 3 -o a.exr --checkpoint 0 --resume";
    ASSERT_EQ(run("render scene.yaml --no-png --passes 3 -o a.exr --resume"), 0);
    EXPECT_THAT(read("err"), HasSubstr("no checkpoint to go on from"));
    const std::string good = read("a.checkpoint.exr");

    EXPECT_EQ(run(render + " --spp 3"), 2);
    EXPECT_THAT(read("err"), HasSubstr("found spp=2, expected spp=3"));
    EXPECT_EQ(run(render + " --seed 3"), 2);
    EXPECT_EQ(run(render + " --method mlt"), 2);
    EXPECT_EQ(run(render + " --resolution 16x24"), 2);
    EXPECT_THAT(read("err"), HasSubstr("found 24 x 16 pixels, expected 16 x 24"));
    std::string other = kScene;
    other.replace(other.find("power: 60"), 9, "power: 61");
    scratch.write("other.yaml", other);
    EXPECT_EQ(run("render other.yaml --no-png --passes 3 -o a.exr --resume"), 2);
    EXPECT_THAT(read("err"), HasSubstr("found another value of 'scene hash'"));

    ASSERT_EQ(run("render scene.yaml -q --no-png --passes 3 -o plain.exr"), 0);
    scratch.write("a.checkpoint.exr", read("plain.exr"));
    EXPECT_EQ(run(render), 2);
    EXPECT_THAT(read("err"), HasSubstr("found no checkpoint"));
    for (const std::size_t size :
         {std::size_t{0}, std::size_t{10}, std::size_t{300}, good.size() / 2, good.size() - 1}) {
        scratch.write("a.checkpoint.exr", good.substr(0, size));
        EXPECT_EQ(run(render), 2) << size << " bytes";
    }
    int refused = 0;
    for (int i = 0; i < 20; ++i) {
        std::string bad = good;
        bad[bad.size() * (2 * static_cast<std::size_t>(i) + 1) / 40] ^= 0x10;
        scratch.write("a.checkpoint.exr", bad);
        const int code = run(render);
        EXPECT_TRUE(code == 0 || code == 2) << code << " " << read("err");
        refused += code == 2 ? 1 : 0;
    }
    EXPECT_GE(refused, 12) << "sums are most of the file";
    scratch.write("a.checkpoint.exr", good);
    EXPECT_EQ(run(render), 0) << read("err");
}

TEST_F(LongRender, GoesOnOnlyWithTheSameUserPaths) {
    scratch.write("narrow.yaml", "paths: [{points: [[0, 3, 0], [0, 1, 0]], beta: 2}]\n");
    scratch.write("wide.yaml", "paths: [{points: [[0, 3, 0], [0, 1, 0]], beta: 9}]\n");
    const std::string render = "render scene.yaml -q --no-png --method ipm -D light_paths=2k --passes 2 ";
    ASSERT_EQ(run(render + "-o a.exr --checkpoint 0 --user-paths narrow.yaml --pass-range 0:1"), 0) << read("err");
    for (const char* other : {"", "--user-paths wide.yaml "}) {
        EXPECT_EQ(run(render + "-o a.exr --resume " + other), 2);
        EXPECT_THAT(read("err"), HasSubstr("found another value of 'user paths' than that of the render"));
        ASSERT_EQ(run(render + "-o b.exr --pass-range 1:2 " + other), 0) << read("err");
        EXPECT_EQ(run("merge a.exr b.exr -o c.exr"), 2);
    }
    EXPECT_EQ(run(render + "-o a.exr --resume --user-paths narrow.yaml"), 0) << read("err");
    ASSERT_EQ(run(render + "-o b.exr --seed 2"), 0) << read("err");
    EXPECT_EQ(run("merge a.exr b.exr -o c.exr"), 0) << "of another seed: both are unbiased; " << read("err");
}

TEST_F(LongRender, InterruptedLeavesACheckpoint) {
    const pid_t pid = start("render scene.yaml --no-png -o a.exr --spp 4 --passes 100k --checkpoint 1000");
    while (read("err").find("path tracing") == std::string::npos && waitpid(pid, nullptr, WNOHANG) == 0) usleep(20'000);
    usleep(200'000); // a round takes less than a hundredth of that
    kill(pid, SIGTERM);
    EXPECT_EQ(wait(pid), 130) << read("err");
    EXPECT_TRUE(read_exr(scratch.path("a.checkpoint.exr")).metadata.contains("units"));
}

TEST_F(LongRender, GoesOnFromWhatAnyProcessLeft) {
    const std::string render = "render scene.yaml -q --no-png --checkpoint 1000 --passes 3 ";
    ASSERT_EQ(run("render scene.yaml -q --no-png -o whole.exr --passes 3"), 0) << read("err");
    for (const std::string part : {"1", "2"}) {
        ASSERT_EQ(run(render + "-o b.exr --pass-range " + part + ":" + std::to_string(std::stoi(part) + 1)), 0);
        std::filesystem::rename(scratch.path("b.checkpoint.exr"), scratch.path("a.checkpoint." + part + ".exr"));
    }
    for (const char* again : {"what is missing", "nothing is missing"}) {
        ASSERT_EQ(run(render + "-o a.exr --resume"), 0) << again << ": " << read("err");
        EXPECT_TRUE(exists("a.checkpoint.exr")) << again;
        EXPECT_FALSE(exists("a.checkpoint.1.exr") || exists("a.checkpoint.2.exr")) << again;
        expect_same("a.exr", "whole.exr");
    }
}

TEST_F(LongRender, KeepsACheckpointUntilThereIsABetterOne) {
    const std::string render = "render scene.yaml -q --no-png -o a.exr --checkpoint 1000 --passes 2 ";
    const auto units = [this] { return read_exr(scratch.path("a.checkpoint.exr")).metadata.at("units"); };
    ASSERT_EQ(run(render + "--pass-range 0:1"), 0) << read("err");
    EXPECT_EQ(units(), "0:2");
    EXPECT_EQ(run(render + "--resume --timeout 0.001"), 0) << read("err");
    EXPECT_EQ(units().substr(0, 2), "0:") << "there was no time for anything";
}

/// Without an effort a pass of photons takes longer than that.
TEST_F(LongRender, FitsPassesIntoATimeThatIsGoneOnWith) {
    const std::string box = "render " KEYHOLE_SOURCE_DIR "/scenes/box.yaml --resolution 24x16 -q --no-png -t 1 ";
    const std::string render = box + "--method ipm -o a.exr --checkpoint 0 --resume ";
    const auto units = [this] { return units_of({"", read_exr(scratch.path("a.checkpoint.exr"))}).size(); };
    std::int64_t before = 0;
    for (const char* time : {"1.5", "2"}) {
        ASSERT_EQ(run(render + "--cpu-time " + time), 0) << read("err");
        EXPECT_GT(units(), before);
        before = units();
    }
    EXPECT_EQ(run(render), 2);
    EXPECT_THAT(read("err"), HasSubstr("expected --timeout or --cpu-time as when it was begun"));
    EXPECT_EQ(run(render + "--cpu-time 1 -D light_paths=7k"), 2);
    EXPECT_THAT(read("err"), HasSubstr("expected light_paths=7000"));
    EXPECT_EQ(units(), before);
}

/// In this scene a pass takes several times as long as in others of the same size and effort.
TEST_F(LongRender, PassesAreAsShortAsTheSceneAsksFor) {
    const std::string lantern = "render " KEYHOLE_SOURCE_DIR
                                "/scenes/lantern.yaml --resolution 96x72 --no-png -t 1 --checkpoint 0 --stats s.json ";
    for (const std::string method : {"auto", "ipm"}) {
        const std::string render = lantern + "--method " + method + " -o " + method + ".exr ";
        const auto units = [&] { return units_of({"", read_exr(scratch.path(method + ".checkpoint.exr"))}).size(); };
        const auto is_tried = [&] { return read("s.json").find("\"trials\"") != std::string::npos; };
        ASSERT_EQ(run(render + "--cpu-time 2"), 0) << read("err");
        EXPECT_TRUE(is_tried()) << method;
        const auto before = units();
        EXPECT_GT(before, 0) << method;
        ASSERT_EQ(run(render + "--cpu-time 1.5 --resume"), 0) << read("err");
        EXPECT_GT(units(), before) << method << ": " << read("err");
        EXPECT_FALSE(is_tried()) << method << ": the checkpoint says which and how long";
        EXPECT_THAT(read("err"), testing::Not(HasSubstr("chosen by trial"))) << method;
    }
}

TEST_F(LongRender, WhereNoUnitFitsIntoTheTimeThereIsAPictureAtMost) {
    const std::string render = "render " KEYHOLE_SOURCE_DIR "/scenes/box.yaml --resolution 24x16 --no-png -o a.exr "
                               "--checkpoint 0 --stats s.json ";
    ASSERT_EQ(run(render + "--method ipm --cpu-time 1 -D cache_rays=1M"), 0) << read("err");
    EXPECT_EQ(nlohmann::json::parse(read("s.json"))["values"]["empty pixels"], 0);
    EXPECT_THAT(read("err"), HasSubstr("stopped before its first unit of work was whole: there is no checkpoint"));
    EXPECT_FALSE(exists("a.checkpoint.exr")) << "the unit's cache lacks records";
    std::filesystem::remove(scratch.path("a.exr"));
    for (const char* much : {"--method ipm -D light_paths=1G", "--method mps -D importons=1G"}) {
        EXPECT_EQ(run(render + "--cpu-time 0.5 " + much), 2) << much;
        EXPECT_THAT(read("err"), testing::ContainsRegex("expected [0-9]+ s at least, or shorter units")) << much;
        EXPECT_FALSE(exists("a.exr") || exists("a.checkpoint.exr")) << much;
    }
}

/// Of a pass that there was no time for nothing is known.
TEST_F(LongRender, WhatWasNotDoneIsNotWarnedOf) {
    const std::string render = "render " KEYHOLE_SOURCE_DIR "/scenes/box.yaml --resolution 24x16 --no-png -o a.exr "
                               "--checkpoint 1000 --method ipm --passes 3 --spp 2 -D light_paths=200k ";
    ASSERT_EQ(run(render + "--pass-range 0:1"), 0) << read("err");
    const std::string there = read("a.checkpoint.exr");
    for (const char* time : {"0.001", "0.05"}) {
        scratch.write("a.checkpoint.exr", there);
        ASSERT_EQ(run(render + "--resume --cpu-time " + std::string(time)), 0) << read("err");
        EXPECT_THAT(read("err"), testing::Not(HasSubstr("no photon was stored"))) << time;
        EXPECT_THAT(read("err"), testing::Not(HasSubstr("hardly a sample meets them"))) << time;
        EXPECT_THAT(read("err"), HasSubstr("the checkpoint is as it was")) << time;
    }
}

TEST_F(LongRender, GoesOnWithTheEffortThatItWasBegunWith) {
    const std::string render = "render scene.yaml -q --no-png --checkpoint 1000 ";
    ASSERT_EQ(run(render + "-o whole.exr --passes 3 --spp 5"), 0) << read("err");
    ASSERT_EQ(run(render + "-o a.exr --passes 3 --spp 5 --pass-range 0:1"), 0) << read("err");
    ASSERT_EQ(run(render + "-o a.exr --resume"), 0) << read("err");
    expect_same("a.exr", "whole.exr");
}

TEST_F(LongRender, ATargetInTheSceneIsThatOfTheOption) {
    std::string text = kScene;
    text.replace(text.find("spp: 2"), 6, "spp: 2, target_error: 0.2");
    scratch.write("target.yaml", text);
    ASSERT_EQ(run("render target.yaml --no-png -o a.exr"), 0) << read("err");
    EXPECT_THAT(read("err"), HasSubstr("24 x 16 pixels, relative error "));
    ASSERT_EQ(run("render scene.yaml -q --no-png -o b.exr --target-error 0.2"), 0) << read("err");
    expect_same("a.exr", "b.exr");
    EXPECT_EQ(read_exr(scratch.path("a.exr")).metadata.at("complete"), "yes");
}

TEST_F(LongRender, ATargetThatIsMissedIsAWarning) {
    for (const char* end : {"--cpu-time 0.3", "--passes 5"}) {
        const std::string render = "render scene.yaml --no-png -o a.exr --target-error 1e-5 " + std::string(end);
        EXPECT_EQ(run(render), 0);
        EXPECT_THAT(read("err"), HasSubstr("not 0.001 % as was asked for"));
        EXPECT_THAT(read("err"), testing::Not(HasSubstr("100 %")));
        EXPECT_EQ(read_exr(scratch.path("a.exr")).metadata.at("complete"), "no");
        EXPECT_EQ(run(render + " --strict"), 3);
    }
    EXPECT_EQ(run("render scene.yaml --no-png -o a.exr --target-error 0.9 --passes 2"), 0);
    EXPECT_THAT(read("err"), HasSubstr("found 2 passes, expected 4 at least: fewer don't tell"));
    EXPECT_THAT(read("err"), HasSubstr("; a smaller spp makes passes shorter"));
    for (const char* error : {"0", "-1", "nan", "2", "x"}) {
        EXPECT_EQ(run("render scene.yaml -o b.exr --target-error " + std::string(error)), 2) << error;
        EXPECT_THAT(read("err"), HasSubstr("expected a relative error above 0")) << error;
    }
    EXPECT_EQ(run("render scene.yaml -q --no-png -o b.exr -D target_error=0"), 0) << "none";
}

TEST_F(LongRender, PassesToAnErrorFitIntoTheTime) {
    for (const char* method : {"auto", "path", "ipm", "mlt"}) {
        ASSERT_EQ(run("render " KEYHOLE_SOURCE_DIR
                      "/scenes/box.yaml --resolution 48x36 --no-png -o a.exr --stats s.json "
                      "--target-error 1e-4 --cpu-time 2 -D max_depth=12 --method " +
                      std::string(method)),
                  0)
            << read("err");
        EXPECT_THAT(read("err"), HasSubstr("not 0.01 % as was asked for")) << method;
        EXPECT_THAT(read("err"), HasSubstr("48 x 36 pixels, relative error ")) << method;
        EXPECT_GE(nlohmann::json::parse(read("s.json"))["values"]["passes"], 4) << method;
        EXPECT_EQ(read_exr(scratch.path("a.exr")).metadata.at("complete"), "no") << method;
    }
}

TEST_F(LongRender, SamplesOfTheFileAreTheMostOfAPassToAnError) {
    std::string text = kScene;
    text.replace(text.find("spp: 2"), 6, "spp: 400");
    scratch.write("fine.yaml", text);
    const auto samples_of_a_pass = [&](const std::string& options) {
        EXPECT_EQ(run("render " + options + " -q --no-png -o a.exr --stats s.json --method path"), 0) << read("err");
        return std::stod(read_exr(scratch.path("a.exr")).metadata.at("samples")) /
               nlohmann::json::parse(read("s.json"))["values"]["passes"].get<double>();
    };
    EXPECT_LT(samples_of_a_pass("fine.yaml --target-error 0.3"), 100) << "a loose one is reached early";
    EXPECT_EQ(samples_of_a_pass("scene.yaml --target-error 0.3"), 2);
    EXPECT_EQ(samples_of_a_pass("fine.yaml --target-error 0.3 --spp 130"), 130) << "named";
    EXPECT_EQ(samples_of_a_pass("fine.yaml --target-error 0.3 --spp 3 --cpu-time 5"), 3);
}

TEST_F(LongRender, ReachesAnErrorByWhateverEffort) {
    ASSERT_EQ(run("render scene.yaml -q --no-png -o a.exr --quality draft --target-error 0.9 --stats s.json"), 0)
        << read("err");
    EXPECT_GE(nlohmann::json::parse(read("s.json"))["values"]["passes"], 4) << "so many tell an error";
}

TEST_F(LongRender, MergesSharesAndSeeds) {
    const std::string render = "render scene.yaml -q --no-png --passes 5 ";
    ASSERT_EQ(run(render + "-o whole.exr"), 0);
    ASSERT_EQ(run(render + "-o a.exr --pass-range 0:2"), 0) << read("err");
    ASSERT_EQ(run(render + "-o b.exr --pass-range 2:5 -t 3"), 0);
    ASSERT_EQ(run(render + "-o overlap.exr --pass-range 1:3"), 0);
    ASSERT_EQ(run("render scene.yaml -q --no-png --passes 15 --seed 2 -o two.exr"), 0);
    ASSERT_EQ(run("merge b.exr a.exr -o c.exr"), 0) << read("err");
    expect_same("c.exr", "whole.exr");
    EXPECT_EQ(read_exr(scratch.path("c.exr")).metadata.at("complete"), "yes");

    ASSERT_EQ(run("merge whole.exr two.exr -o mean.exr --no-png"), 0) << read("err");
    const Picture one = read_exr(scratch.path("whole.exr")), two = read_exr(scratch.path("two.exr")),
                  mean = read_exr(scratch.path("mean.exr"));
    for (const auto& [name, image] : mean.layers)
        for (std::size_t i = 0; i < image.data.size(); ++i)
            EXPECT_FLOAT_EQ(image.data[i], 0.25f * one.layers.at(name).data[i] + 0.75f * two.layers.at(name).data[i]);
    EXPECT_EQ(mean.metadata.at("seed"), "1,2");
    EXPECT_EQ(mean.metadata.at("samples"), "40");

    std::string other = kScene;
    other.replace(other.find("0, 0, 3"), 7, "0, 0, 4");
    scratch.write("other.yaml", other);
    ASSERT_EQ(run("render other.yaml -q --no-png --passes 5 -o other.exr"), 0);
    ASSERT_EQ(run(render + "-o depth.exr --seed 9 -D max_depth=3"), 0);
    for (const auto& [inputs, message] : std::initializer_list<std::pair<const char*, const char*>>{
             {"a.exr overlap.exr", "found work that is in another of the pictures too"},
             {"whole.exr whole.exr", "found the seed 1 again"},
             {"whole.exr other.exr", "found another value of 'scene hash'"},
             {"whole.exr depth.exr", "found max_depth=3, expected max_depth=24"},
             {"whole.exr none.exr", "cannot read"}}) {
        EXPECT_EQ(run(std::string("merge -o m.exr ") + inputs), 2) << inputs;
        EXPECT_THAT(read("err"), HasSubstr(message)) << inputs;
    }
    for (const char* range : {"3", "3:", ":3", "3:3", "4:2", "-1:2", "0:6", "0:2x"})
        EXPECT_EQ(run(render + "-o d.exr --pass-range=" + range), 2) << range;
    EXPECT_EQ(run(render + "-o d.exr --checkpoint nan"), 2);
    for (const char* part : {"--checkpoint 1", "--resume", "--pass-range 0:1"}) {
        EXPECT_EQ(run(render + "-o d.exr -D adaptive=true " + part), 2) << part;
        EXPECT_THAT(read("err"), HasSubstr("found adaptive=true")) << part;
    }
    EXPECT_FALSE(exists("m.exr") || exists("d.exr"));
}
