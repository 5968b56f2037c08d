// The program from outside: time budgets, the picture so far, plans, charts that go on where they stopped.
#include "film/files/exr.h"
#include "support/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>

using namespace keyhole;
using testing::HasSubstr;
using testing::Not;

TEST_F(Program, HangupWritesThePictureSoFarAndTheRenderGoesOn) {
    const pid_t pid = start("render scene.yaml -o a.exr --spp 10M");
    const auto running = [&] { return waitpid(pid, nullptr, WNOHANG) == 0; };
    while (read("err").find("path tracing") == std::string::npos && running()) usleep(20'000);
    kill(pid, SIGHUP);
    while (!exists("a.png") && running()) usleep(20'000);
    EXPECT_TRUE(running());
    const Picture so_far = read_exr(scratch.path("a.exr"));
    EXPECT_EQ(so_far.metadata.at("complete"), "no");
    EXPECT_TRUE(so_far.layers.contains("beauty"));
    kill(pid, SIGINT);
    EXPECT_EQ(wait(pid), 130) << read("err");
}

TEST_F(Program, HangupWithoutAPlaceToWriteToIsNoEnd) {
    std::filesystem::create_directory(scratch.path("pictures"));
    const pid_t pid = start("render scene.yaml -o pictures/a.exr --no-png --spp 10M");
    const auto running = [&] { return waitpid(pid, nullptr, WNOHANG) == 0; };
    while (read("err").find("path tracing") == std::string::npos && running()) usleep(20'000);
    std::filesystem::remove(scratch.path("pictures"));
    kill(pid, SIGHUP);
    while (read("err").find("no picture so far") == std::string::npos && running()) usleep(20'000);
    EXPECT_TRUE(running()) << read("err");
    std::filesystem::create_directory(scratch.path("pictures"));
    kill(pid, SIGINT);
    EXPECT_EQ(wait(pid), 130) << read("err");
    EXPECT_TRUE(exists("pictures/a.exr"));
}

TEST_F(Program, CpuTimeSetsSamplesAndPhotons) {
    ASSERT_EQ(run("render scene.yaml -o a.exr --cpu-time 2 --method ipm --stats s.json --no-png"), 0) << read("err");
    const auto stats = nlohmann::json::parse(read("s.json"));
    EXPECT_THAT(stats["remarks"].dump(), HasSubstr("set by the time:"));
    EXPECT_GT(stats["values"]["effort"], 0);
    EXPECT_EQ(stats["stages"][0]["name"], "loading");
    EXPECT_EQ(stats["stages"][1]["name"], "openings");
    EXPECT_EQ(stats["stages"][2]["name"], "trials");
    const std::string settings = read_exr(scratch.path("a.exr")).metadata.at("settings");
    EXPECT_THAT(settings, testing::Not(HasSubstr("light_paths=1000000 ")));
    // What the command line names stays.
    ASSERT_EQ(run("render scene.yaml -o b.exr --cpu-time 2 --method ipm --spp 3 --no-png -q"), 0) << read("err");
    EXPECT_THAT(read_exr(scratch.path("b.exr")).metadata.at("settings"), HasSubstr("spp=3 "));
}

/// Where there is no time for photons, paths are traced: noisy, not wrong.
TEST_F(Program, TooLittleTimeForPhotonsStillGivesAPicture) {
    ASSERT_EQ(run("render scene.yaml -o a.exr --cpu-time 0.001 --method auto --stats s.json --no-png -q"), 0)
        << read("err");
    EXPECT_EQ(nlohmann::json::parse(read("s.json"))["method"], "path");
    EXPECT_FALSE(read_exr(scratch.path("a.exr")).layers.at("beauty").data.empty());
}

TEST_F(Program, AMethodByNameIsThatMethodOrAnError) {
    ASSERT_EQ(run("render scene.yaml -o a.exr --cpu-time 2 --method pm --stats s.json --no-png -q"), 0) << read("err");
    EXPECT_EQ(nlohmann::json::parse(read("s.json"))["method"], "pm");
    for (const char* method : {"pm", "ipm", "mps", "mlt"}) { // also where openings are looked for before
        EXPECT_EQ(run(std::string("render scene.yaml -o b.exr --cpu-time 0.001 --no-png -q --method ") + method), 2);
        EXPECT_THAT(read("err"), HasSubstr(std::string("too little time for ") + method));
    }
    EXPECT_FALSE(std::filesystem::exists(scratch.path("b.exr")));
}

TEST_F(Program, QualityIsEffortInOneWord) {
    std::int64_t before = 0;
    for (const char* quality : {"draft", "good"}) {
        ASSERT_EQ(run(std::string("render scene.yaml -o a.exr -q --no-png --quality ") + quality), 0) << read("err");
        const std::string settings = read_exr(scratch.path("a.exr")).metadata.at("settings");
        const std::int64_t spp = std::stoll(settings.substr(settings.find("spp=") + 4));
        EXPECT_GT(spp, before);
        before = spp;
    }
}

/// Of the candidates for a reference mlt has too little time here.
TEST_F(Program, AChartMakesItsReferenceByWhatHasTheTime) {
    EXPECT_EQ(
        run("chart scene.yaml --times 0.002 --methods path --repeats 1 --reference-time 1 --resolution 16x12 -o rep "),
        0)
        << read("err");
    EXPECT_TRUE(exists("rep/index.html"));
    EXPECT_THAT(read("err"), HasSubstr("no reference by mlt: "));
    EXPECT_THAT(read("err"), Not(HasSubstr("no reference by path: ")));
}

/// Too little time for it, however fast the machine: half a million paths.
TEST_F(Program, EveryPixelGetsASampleByBidirectionalPathTracing) {
    ASSERT_EQ(run("render " KEYHOLE_SOURCE_DIR "/scenes/box.yaml --resolution 800x600 --method bdpt --cpu-time 0.1 -q "
                  "--no-png --denoise off -o a.exr --stats s.json"),
              0)
        << read("err");
    EXPECT_EQ(nlohmann::json::parse(read("s.json"))["values"]["empty pixels"], 0);
}

TEST_F(Program, SaysThatPixelsAreNoiseAlone) {
    const std::string hard = "render " KEYHOLE_SOURCE_DIR "/scenes/failures/keyhole.yaml --resolution 24x16 --no-png ";
    EXPECT_EQ(run(hard + "--method path --spp 16 -o a.exr --strict"), 3) << read("err");
    EXPECT_THAT(read("err"), HasSubstr("pixels are known to "));
    ASSERT_EQ(run("render scene.yaml --no-png --spp 16 -o b.exr"), 0);
    EXPECT_THAT(read("err"), testing::Not(HasSubstr("pixels are known to ")));
}

TEST_F(Program, SuggestsNoPathsFromTheSky) {
    scratch.write("sky.yaml", "camera: {from: [0, 0, 3], to: [0, 0, 0]}\nmaterials: {white: {type: diffuse}}\n"
                              "shapes: [{type: sphere, material: white}]\nemitters: [{type: environment}]\n");
    EXPECT_EQ(run("paths suggest sky.yaml -t 1"), 2);
    EXPECT_THAT(read("err"), HasSubstr("sky.yaml: found light from infinitely far away alone, expected emitters"));
}

TEST_F(Program, SuggestedPathsPassTheirCheckAndAreShown) {
    const std::string box = KEYHOLE_SOURCE_DIR "/scenes/box.yaml ";
    ASSERT_EQ(run("paths suggest " + box + "-n 60 -D brightness_samples=5k -t 1 -o p.yaml"), 0) << read("err");
    EXPECT_EQ(run("paths check " + box + "p.yaml"), 0) << read("err");
    EXPECT_EQ(run("paths show " + box + "p.yaml --resolution 16x16 -D spp=1 -t 1 -o p.png"), 0) << read("err");
    EXPECT_TRUE(exists("p.png"));
}

TEST_F(Program, PlanTellsWhatIsLeftOutAndWhy) {
    ASSERT_EQ(run("plan scene.yaml --json -D method=ipm -D light_paths=20k"), 0) << read("err");
    const auto plan = nlohmann::json::parse(read("out"));
    EXPECT_EQ(plan["method"], "ipm");
    bool caustics = true;
    for (const auto& choice : plan["choices"]) {
        EXPECT_FALSE(choice["why"].get<std::string>().empty());
        if (choice["name"] == "caustic map and proposals") caustics = choice["on"];
    }
    EXPECT_FALSE(caustics);
    EXPECT_EQ(plan["found"]["emitters"].size(), 1u);
    EXPECT_GT(plan["found"]["light"]["direct"], 0.1);
    EXPECT_GT(plan["cpu_seconds"], 0);
    scratch.write("paths.yaml", "paths: [{points: [[0, 3, 0], [0, 1, 0]]}]\n");
    for (const char* option :
         {"--cpu-time 2", "--timeout 2 -t 1", "--spp 4", "--quality draft -t 1", "--user-paths paths.yaml"})
        EXPECT_EQ(run("plan scene.yaml --json " + std::string(option)), 0) << option << ": " << read("err");
    ASSERT_EQ(run("plan scene.yaml --json --method path --cpu-time 3"), 0) << read("err");
    const auto paths = nlohmann::json::parse(read("out"));
    EXPECT_EQ(paths["method"], "path");
    EXPECT_NEAR(paths["cpu_seconds"], 3, 1.5);
    for (const auto& choice : paths["choices"]) EXPECT_EQ(choice["on"], false) << choice["name"];
    ASSERT_EQ(run("plan scene.yaml --json --method auto --cpu-time 3"), 0) << read("err");
    const auto timed = nlohmann::json::parse(read("out"));
    EXPECT_GT(timed["stages"]["trials"], 0) << "which are within the time";
    EXPECT_NEAR(timed["cpu_seconds"], 3, 1.5);
    ASSERT_EQ(run("plan scene.yaml -D light_paths=20k"), 0);
    EXPECT_THAT(read("out"), HasSubstr("off         caustic map and proposals: "));
    EXPECT_THAT(read("out"), Not(HasSubstr("paths from the eye find it")));
}

TEST_F(Program, PlanSaysWhatPhotonsTakeAtMostAndOfWhat) {
    const std::string box = "plan " KEYHOLE_SOURCE_DIR "/scenes/box.yaml --method ipm -D light_paths=20k ";
    ASSERT_EQ(run(box + "--json --photon-memory 16384GiB"), 0) << read("err");
    const auto plan = nlohmann::json::parse(read("out"));
    EXPECT_EQ(plan["photon_memory"], 16384ll << 30);
    EXPECT_GT(plan["photon_bytes"], 100'000);
    EXPECT_LT(plan["photon_bytes"], 100 << 20) << "no more than 20k light paths leave";
    ASSERT_EQ(run(box + "--photon-memory 300kB"), 0) << read("err");
    EXPECT_THAT(read("out"),
                HasSubstr("memory      at most 300 kB for photons and what serves them, of photon_memory=300 kB"));
}

TEST_F(Program, PlanSaysWhatItsSharesAreOf) {
    std::string shiny = kScene;
    shiny.replace(shiny.find("{type: diffuse}"), 15, "{type: plastic, roughness: 0}");
    scratch.write("shiny.yaml", shiny);
    ASSERT_EQ(run("plan shiny.yaml -D light_paths=20k"), 0) << read("err");
    EXPECT_THAT(read("out"), HasSubstr("some are of several kinds, and count for each"));
    EXPECT_THAT(read("out"), HasSubstr("as 4096 paths from the eye find it: caustics of lamps that these hardly ever"));
}

TEST_F(Program, ChartGoesOnWhereItStopped) {
    const std::string chart = "chart scene.yaml --times 0.3 --repeats 2 --reference-time 2 -j 2 -o report --methods ";
    ASSERT_EQ(run(chart + "path"), 0) << read("err");
    EXPECT_THAT(read("err"), HasSubstr("2 runs, 2 of them to be made"));
    ASSERT_EQ(run(chart + "path,ipm"), 0) << read("err");
    EXPECT_THAT(read("err"), HasSubstr("4 runs, 2 of them to be made"));
    for (const char* file : {"points.csv", "runs.csv", "stages.csv", "methods.csv", "index.html"})
        EXPECT_TRUE(exists(std::string("report/") + file)) << file;
    const std::string page = read("report/index.html");
    EXPECT_THAT(page, HasSubstr("data:image/png;base64,"));
    EXPECT_LT(page.size(), 5'000'000u);
    // Other settings make other pictures.
    ASSERT_EQ(run(chart + "path -D max_depth=2"), 0) << read("err");
    EXPECT_THAT(read("err"), HasSubstr("2 runs, 2 of them to be made"));
    std::string text = read("scene.yaml");
    text.replace(text.find("spp: 2"), 6, "max_depth: 3");
    scratch.write("scene.yaml", text);
    ASSERT_EQ(run(chart + "path"), 0) << read("err");
    EXPECT_THAT(read("err"), HasSubstr("2 runs, 2 of them to be made"));
}
