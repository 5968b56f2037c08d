// The program from outside: exit codes, messages, files.
#include "film/files/exr.h"
#include "support/program.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <sys/wait.h>

using namespace keyhole;
using testing::HasSubstr;
using testing::StartsWith;

TEST_F(Program, RenderWritesPicturesWithTheirHistory) {
    ASSERT_EQ(run("render scene.yaml -D seed=5 --resolution 20x10 --stats s.json"), 0) << read("err");
    const Picture p = read_exr(scratch.path("scene.exr"));
    EXPECT_EQ(p.width, 20);
    EXPECT_EQ(p.height, 10);
    EXPECT_EQ(p.layers.size(), 7u);
    EXPECT_EQ(p.metadata.at("command"), "keyhole render scene.yaml -D seed=5 --resolution 20x10 --stats s.json");
    EXPECT_EQ(p.metadata.at("seed"), "5");
    EXPECT_EQ(p.metadata.at("scene"), "scene.yaml");
    EXPECT_THAT(p.metadata.at("settings"),
                HasSubstr("method=path plan=auto gather_coverage=true spp=2 keep_spp=false adaptive=false seed=5"));
    for (const char* key : {"program", "rays", "seconds", "peak memory", "stage path tracing"})
        EXPECT_TRUE(p.metadata.contains(key)) << key;
    EXPECT_TRUE(exists("scene.png"));
    EXPECT_EQ(nlohmann::json::parse(read("s.json"))["complete"], true);
}

TEST_F(Program, OptionsAndSettingsMeanTheSameAndTheLastSettingWins) {
    ASSERT_EQ(run("render scene.yaml -o a.exr --spp 0.004k --seed 7 --no-png -q"), 0);
    ASSERT_EQ(run("render scene.yaml -o b.exr -D spp=9 -D spp=4 -D seed=7 --no-png -q -t 3"), 0);
    EXPECT_EQ(read("out") + read("err"), "");
    EXPECT_FALSE(exists("a.png"));
    const Picture a = read_exr(scratch.path("a.exr")), b = read_exr(scratch.path("b.exr"));
    EXPECT_EQ(a.metadata.at("settings"), b.metadata.at("settings"));
    for (const auto& [name, image] : a.layers) EXPECT_EQ(image.data, b.layers.at(name).data) << name;
}

// Whatever shares are tried where none is given.
TEST_F(Program, AShareOfChainsThatIsGivenIsTheShare) {
    // Light goes from one side of a corner to the other.
    scratch.write("corner.yaml",
                  "film: {resolution: [24, 16]}\n"
                  "camera: {from: [3, 2, 3], to: [0, 0.5, 0]}\n"
                  "materials: {white: {type: diffuse}}\n"
                  "shapes:\n"
                  "  - {type: rectangle, corner: [0, 0, 0], u: [0, 0, 4], v: [4, 0, 0], material: white}\n"
                  "  - {type: rectangle, corner: [0, 0, 0], u: [0, 4, 0], v: [0, 0, 4], material: white}\n"
                  "  - {type: rectangle, corner: [1, 3, 1], u: [1, 0, 0], v: [0, 0, 1], emission: {power: 60}}\n");
    for (const double share : {0.0, 0.3, 0.77}) {
        ASSERT_EQ(
            run(fmt::format("render corner.yaml --method cps -D plan=all -D light_paths=2000 -D mutations=2000 -D "
                            "chain_share={} -q --no-png -o a.exr --stats s.json",
                            share)),
            0)
            << read("err");
        EXPECT_EQ(nlohmann::json::parse(read("s.json"))["values"]["share of chains"], share);
    }
}

TEST_F(Program, BadInputExitsWithTwoAndOneLine) {
    scratch.write("bad.exr", "no picture");
    scratch.write("broken.yaml", "paths: [{points: 3}]\n");
    scratch.write("blocked.yaml", "paths: [{points: [[0, 3, 0], [0, -1, 0]]}]\n");
    for (const char* arguments : {"",
                                  "render",
                                  "frobnicate",
                                  "render none.yaml",
                                  "render scene.yaml --spp 0",
                                  "render scene.yaml --spp many",
                                  "render scene.yaml -D nothing=1",
                                  "render scene.yaml -D spp",
                                  "render scene.yaml --resolution 20",
                                  "render scene.yaml --resolution 0x5",
                                  "render scene.yaml --resolution 20x10x5",
                                  "render scene.yaml -o . ",
                                  "render scene.yaml -o missing/a.exr",
                                  "render scene.yaml -o a.png",
                                  "render scene.yaml -o a.exr --png a.exr",
                                  "render scene.yaml -o a.exr --png missing/a.png",
                                  "render scene.yaml --png a.png --no-png",
                                  "render scene.yaml --stats missing/s.json",
                                  "render scene.yaml -q -v",
                                  "render scene.yaml --method path --save-map a.photons",
                                  "render scene.yaml --method path --load-map a.photons",
                                  "render scene.yaml -t -1",
                                  "render scene.yaml --passes 0",
                                  "render scene.yaml --passes 0 --method ipm",
                                  "render scene.yaml --timeout -1",
                                  "render scene.yaml --cpu-time nan",
                                  "render scene.yaml --timeout nan",
                                  "render scene.yaml --timeout 0",
                                  "render scene.yaml --cpu-time 0",
                                  "render scene.yaml --cpu-time 1 --timeout 1",
                                  "render scene.yaml --quality best",
                                  "render none.yaml --quality best",
                                  "chart none.yaml",
                                  "chart scene.yaml --times 1,x",
                                  "chart scene.yaml --methods path,frobnicate",
                                  "chart scene.yaml --methods path:nothing=1",
                                  "chart scene.yaml --memory little",
                                  "chart scene.yaml --reference none.exr",
                                  "chart scene.yaml scene.yaml",
                                  "render scene.yaml --user-paths none.yaml",
                                  "render scene.yaml --user-paths broken.yaml",
                                  "render scene.yaml --method mlt --user-paths blocked.yaml",
                                  "paths",
                                  "paths check scene.yaml",
                                  "paths check scene.yaml broken.yaml",
                                  "paths check scene.yaml blocked.yaml",
                                  "paths show scene.yaml blocked.yaml",
                                  "paths suggest none.yaml",
                                  "paths suggest scene.yaml -n 0",
                                  "paths trace scene.yaml --from 0 3 0 --dir 0 0 0",
                                  "paths trace scene.yaml --from 0 3 --dir 0 1 0",
                                  "diff bad.exr bad.exr",
                                  "diff none.exr none.exr",
                                  "diff bad.exr"}) {
        EXPECT_EQ(run(arguments), 2) << arguments;
        const std::string message = read("err");
        EXPECT_THAT(message.substr(message.rfind('\n', message.size() - 2) + 1), StartsWith("keyhole: ")) << arguments;
        EXPECT_FALSE(exists("a.exr") || exists("scene.exr")) << arguments;
    }
}

TEST_F(Program, MistakesInCommandsSayWhatWasMeant) {
    EXPECT_EQ(run("rendr scene.yaml"), 2);
    EXPECT_THAT(read("err"), HasSubstr("found the command 'rendr', expected one of chart, diff"));
    EXPECT_THAT(read("err"), HasSubstr("did you mean 'render'?"));
    EXPECT_EQ(run("scene.yaml"), 2);
    EXPECT_THAT(read("err"), HasSubstr("found the command 'scene.yaml'"));
    EXPECT_EQ(run("render scene.yaml --sppp 3"), 2);
    EXPECT_THAT(read("err"), HasSubstr("found --sppp 3, which render doesn't take; did you mean '--spp'?"));
    EXPECT_EQ(run("info scene.yaml -D spp=3"), 2);
    EXPECT_THAT(read("err"), HasSubstr("found -D spp=3, which info doesn't take (see --help)"));
    EXPECT_EQ(run("render scene.yaml --photon-memory 1m"), 2);
    EXPECT_THAT(read("err"), HasSubstr("expected a whole number from 256KiB to 16384GiB, as 32MiB or 32MB"));
    EXPECT_EQ(run("render scene.yaml --passes 0 -o a.exr"), 2);
    EXPECT_THAT(read("err"), HasSubstr("found passes=0 and no end, expected --timeout, --cpu-time or --target-error"));
    EXPECT_EQ(run("render scene.yaml -D spp 4"), 2);
    EXPECT_THAT(read("err"), HasSubstr("-D KEY=VALUE"));
}

TEST_F(Program, UserPathsWithoutEffectAreTold) {
    scratch.write("paths.yaml", "paths: [{points: [[0, 3, 0], [0, 1, 0]]}]\n");
    ASSERT_EQ(run("render scene.yaml --no-png -o a.exr --user-paths paths.yaml"), 0) << read("err");
    EXPECT_THAT(read("err"), HasSubstr("user paths have no effect on method path"));
    ASSERT_EQ(run("render scene.yaml --no-png -o a.exr --user-paths paths.yaml --method ipm -D light_paths=2k"), 0);
    EXPECT_THAT(read("err"), testing::Not(HasSubstr("no effect")));
}

TEST_F(Program, ARenderInTimeCanBeMadeAgainAndMerged) {
    const std::string paths = "render scene.yaml -q --no-png --method path -D adaptive=false --spp 4 ";
    ASSERT_EQ(run(paths + "--cpu-time 2 -o a.exr"), 0) << read("err");
    ASSERT_EQ(run(paths + "-o b.exr"), 0) << read("err");
    EXPECT_EQ(read_exr(scratch.path("a.exr")).layers.at("beauty").data,
              read_exr(scratch.path("b.exr")).layers.at("beauty").data);
    const std::string photons = "render scene.yaml -q --no-png --method ipm ";
    ASSERT_EQ(run(photons + "--cpu-time 0.6 -o c.exr"), 0) << read("err");
    ASSERT_EQ(run(photons + "--cpu-time 0.9 --seed 2 -o d.exr"), 0) << read("err");
    EXPECT_EQ(run("merge c.exr d.exr --no-png -o e.exr"), 0) << read("err");
    EXPECT_TRUE(exists("e.exr"));
}

TEST_F(Program, APictureWithoutLightSaysWhy) {
    scratch.write("dark.yaml", "film: {resolution: [8, 6]}\ncamera: {from: [0, 0, 3], to: [0, 0, 0], fov: 40}\n"
                               "shapes: [{type: sphere, radius: 1, material: {type: diffuse}}]\n");
    EXPECT_EQ(run("render dark.yaml --method path --spp 4 --no-png -o a.exr"), 0) << read("err");
    EXPECT_THAT(read("err"), HasSubstr("nothing in the scene emits light"));
}

TEST_F(Program, WordsThatAreNotUtf8AreWarnedOf) {
    scratch.write("a.pbrt",
                  "Integrator \"path\" \"integer \xFFx\" 3 Camera \"perspective\" WorldBegin Shape \"sphere\"");
    EXPECT_EQ(run("render a.pbrt --resolution 8x6 --spp 1 --no-png --stats s.json -o a.exr"), 0) << read("err");
    EXPECT_THAT(read("s.json"), HasSubstr("\xEF\xBF\xBDx")) << read("s.json");
}

TEST_F(Program, NamesThatAreNotUtf8LoseNoPage) {
    std::filesystem::copy(scratch.path("scene.yaml"), scratch.path("caf\xe9.yaml"));
    EXPECT_EQ(run("inspect caf\xe9.yaml -o page.html --resolution 8x6 -D light_paths=1000"), 0) << read("err");
    EXPECT_THAT(read("err"), HasSubstr("gather: ")) << "what takes long says what it does";
    EXPECT_THAT(read("page.html"), HasSubstr("caf\xEF\xBF\xBD"));
    EXPECT_EQ(run("chart caf\xe9.yaml --methods path --times 0.3 --reference-time 2 --repeats 1 -o report"), 0)
        << read("err");
    EXPECT_TRUE(exists("report/index.html"));
}

TEST_F(Program, ATimeoutLeavesWhatThereIs) {
    ASSERT_EQ(run("render scene.yaml -o a.exr --spp 10M --timeout 0.5"), 0) << read("err");
    EXPECT_EQ(read_exr(scratch.path("a.exr")).metadata.at("complete"), "no");
}

TEST_F(Program, ASignalLeavesWhatThereIsAndExitsWith130) {
    for (const int signal : {SIGINT, SIGTERM}) {
        const pid_t pid = start("render scene.yaml -o a.exr --spp 10M");
        // The first line of progress says that samples are taken.
        while (read("err").find("path tracing") == std::string::npos && waitpid(pid, nullptr, WNOHANG) == 0)
            usleep(20'000);
        kill(pid, signal);
        EXPECT_EQ(wait(pid), 130) << read("err");
        EXPECT_EQ(read_exr(scratch.path("a.exr")).metadata.at("complete"), "no");
        std::filesystem::remove(scratch.path("a.exr"));
        std::filesystem::remove(scratch.path("err"));
    }
}

TEST_F(Program, DiffPrintsMeasuresAsJson) {
    ASSERT_EQ(run("render scene.yaml -o a.exr -q --no-png"), 0);
    ASSERT_EQ(run("render scene.yaml -o b.exr -q --no-png --seed 2"), 0);
    ASSERT_EQ(run("diff a.exr a.exr"), 0);
    EXPECT_EQ(nlohmann::json::parse(read("out"))["relmse"], 0);
    ASSERT_EQ(run("diff a.exr b.exr a.exr"), 0);
    const auto json = nlohmann::json::parse(read("out"));
    EXPECT_GT(json["relmse"], 0);
    EXPECT_NEAR(json["ratio"].get<double>(), 1, 0.2);
    EXPECT_TRUE(json.contains("cross_trim"));
}

TEST_F(Program, VersionAndHelpAreNoErrors) {
    EXPECT_EQ(run("--version"), 0);
    EXPECT_THAT(read("out"), testing::AllOf(StartsWith("keyhole "), HasSubstr("embree 3.")));
    EXPECT_EQ(run("render --help"), 0);
    EXPECT_THAT(read("out"), testing::AllOf(HasSubstr("--mutations"), HasSubstr("samples per pixel")));
}

TEST_F(Program, InfoTellsWhatASceneConsistsOf) {
    scratch.write("info.yaml",
                  "film: {resolution: [24, 16]}\n"
                  "camera: {from: [0, 0, 9], to: [0, 0, 0], fov: 30}\n"
                  "materials: {white: {type: diffuse}, ball: {type: glass}, picture: {type: diffuse, reflectance: "
                  "{type: image, file: wall.pfm}}}\n"
                  "groups: {pair: [{type: sphere, material: white, radius: 0.1}, {type: sphere, material: ball, "
                  "radius: 0.1, center: [0.5, 0, 0]}]}\n"
                  "shapes:\n"
                  "  - {type: rectangle, material: picture}\n"
                  "  - {type: instance, group: pair, transform: {translate: [0, 0, 1]}}\n"
                  "  - {type: instance, group: pair, transform: {translate: [0, 1, 1]}}\n"
                  "  - {type: rectangle, corner: [-1, 3, -1], u: [2, 0, 0], v: [0, 0, 2], emission: {power: 60}}\n"
                  "emitters: [{type: point, position: [0, 2, 2], power: 5}]\n");
    std::string floats = "PF\n2 2\n-1.0\n";
    floats.append(2 * 2 * 3 * sizeof(float), '\0');
    scratch.write("wall.pfm", floats);
    ASSERT_EQ(run("info info.yaml --json"), 0) << read("err");
    const auto info = nlohmann::json::parse(read("out"));
    EXPECT_EQ(info["triangles"], 4);
    EXPECT_EQ(info["spheres"], 4);
    EXPECT_EQ(info["shapes"], 6);
    EXPECT_EQ(info["instances"], 2);
    EXPECT_EQ(info["materials"], (nlohmann::json{{"diffuse", 3}, {"glass", 1}}));
    ASSERT_EQ(info["emitters"].size(), 2u);
    double powers = 0;
    for (const auto& e : info["emitters"]) powers += e["power"].get<double>();
    EXPECT_NEAR(powers, 65, 1e-3);
    EXPECT_NEAR(info["power"].get<double>(), 65, 1e-3);
    ASSERT_EQ(info["textures"].size(), 1u);
    EXPECT_EQ(info["textures"][0]["bytes"], 2 * 2 * 3 * 4);
    EXPECT_EQ(info["memory"]["textures"], 2 * 2 * 3 * 4);
    EXPECT_GT(info["memory"]["embree"].get<double>(), info["memory"]["geometry"].get<double>());
    EXPECT_EQ(info["bounds"]["upper"], nlohmann::json({1, 3, 1.1f}));
    EXPECT_NEAR(info["camera"]["fov"].get<double>(), 30, 1e-5);

    ASSERT_EQ(run("info info.yaml"), 0);
    EXPECT_THAT(read("out"), testing::AllOf(HasSubstr("4 triangles"), HasSubstr("1 glass"), HasSubstr("area: 60 W"),
                                            HasSubstr("wall.pfm"), HasSubstr("2 instances")));
}

TEST_F(Program, InfoListsPicturesOfLampsAndCountsLampsWithoutMaterialOnce) {
    std::string lamps, floats = "PF\n2 2\n-1.0\n";
    for (int i = 0; i < 12; ++i) floats.append("\0\0\x80\x3f", 4);
    scratch.write("gobo.pfm", floats);
    scratch.write("sky.pfm", floats);
    for (const char* x : {"0", "2", "4"})
        lamps += std::string("  - {type: sphere, center: [") + x + ", 5, 0], radius: 0.1, emission: {power: 1}}\n";
    scratch.write("lamps.yaml",
                  kScene + std::string("emitters:\n  - {type: projection, position: [0, 2, 2], power: 1, image: "
                                       "gobo.pfm}\n  - {type: environment, image: sky.pfm}\n"));
    std::string text = read("lamps.yaml");
    scratch.write("lamps.yaml", text.insert(text.find("render:"), lamps));
    ASSERT_EQ(run("info lamps.yaml --json"), 0) << read("err");
    const auto info = nlohmann::json::parse(read("out"));
    EXPECT_EQ(info["materials"], (nlohmann::json{{"diffuse", 2}}));
    ASSERT_EQ(info["textures"].size(), 2u);
    EXPECT_THAT(info["textures"][0]["file"].get<std::string>(), HasSubstr("gobo.pfm"));
    EXPECT_EQ(info["textures"][0]["width"], 2);
}

TEST_F(Program, ABlackPictureIsCalledBlackByPhotonsToo) {
    std::string text = kScene;
    text.insert(text.find("render:"), "  - {type: box, material: white, min: [-2, 2, -2], max: [2, 4, 2]}\n");
    scratch.write("dark.yaml", text);
    for (const char* method : {"path", "ipm", "pm"}) {
        ASSERT_EQ(run("render dark.yaml --no-png -o a.exr -D light_paths=2k --method " + std::string(method)), 0);
        EXPECT_THAT(read("err"), HasSubstr("the picture is black")) << method;
    }
}

TEST_F(Program, AMistakeOfAnEntryWithBouncesIsToldOnce) {
    scratch.write("paths.yaml", "paths:\n  - points: [[0, 3, 0], {bounces: [1, 10]}, {through: {corner: [2, 0, 0], "
                                "u: [0, 1, 0], v: [0, 0, 1]}}, [0, -3, 0]]\n");
    EXPECT_EQ(run("paths check scene.yaml paths.yaml"), 2);
    const std::string out = read("out");
    EXPECT_EQ(out.find("point 4: found"), out.rfind("point 4: found"));
    EXPECT_THAT(out, HasSubstr("from the middle of the opening"));
    EXPECT_THAT(read("err"), testing::Not(HasSubstr("more)")));
}

TEST_F(Program, SamplesThatAreNamedAreKeptWhateverAutoTakes) {
    const auto samples = [&](const std::string& options) {
        EXPECT_EQ(run("render scene.yaml --no-png -o a.exr --method auto -D max_depth=1 " + options), 0) << read("err");
        return std::stod(read_exr(scratch.path("a.exr")).metadata.at("samples"));
    };
    EXPECT_EQ(samples("--spp 3"), 3);
    EXPECT_THAT(read("err"), testing::Not(HasSubstr("samples a pixel instead")));
    EXPECT_GT(samples("-D plan=auto"), 2) << "of the scene";
    EXPECT_THAT(read("err"), HasSubstr(" samples a pixel instead of 2 take the work that the settings ask for"));
    EXPECT_EQ(samples("-D keep_spp=true"), 2);
}

TEST_F(Program, InfoReadsPbrtAndPassesItsWarningsOn) {
    scratch.write("scene.pbrt", "WorldBegin\nObjectBegin \"one\" Shape \"sphere\" ObjectEnd\n"
                                "ObjectInstance \"one\" Material \"velvet\"\n");
    EXPECT_EQ(run("info scene.pbrt"), 2);
    scratch.write("scene.pbrt", "Film \"spectral\"\nWorldBegin\nObjectBegin \"one\" Shape \"sphere\" ObjectEnd\n"
                                "ObjectInstance \"one\" ObjectInstance \"one\"\n");
    ASSERT_EQ(run("info scene.pbrt --json"), 0) << read("err");
    const auto info = nlohmann::json::parse(read("out"));
    EXPECT_EQ(info["instances"], 2);
    EXPECT_EQ(info["resolution"], nlohmann::json({1280, 720}));
    ASSERT_EQ(info["warnings"].size(), 1u);
    EXPECT_THAT(info["warnings"][0].get<std::string>(), HasSubstr("Film \"spectral\""));
}
