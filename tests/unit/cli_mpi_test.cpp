// keyhole-mpi: any number of processes makes the picture that one makes.
#include "film/files/exr.h"
#include "support/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

using namespace keyhole;
using testing::HasSubstr;

namespace {

class Ranks : public Program {
  protected:
    void SetUp() override {
        if (std::string(KEYHOLE_MPI_EXECUTABLE).empty()) GTEST_SKIP() << "built without MPI";
        if (std::system("mpirun --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no mpirun here (openmpi-bin)";
        setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
        setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
        // What Open MPI's plug-ins forget is told of places that are unloaded by then: no suppression matches.
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
    }
    static std::string mpirun(int ranks) {
        return "mpirun --oversubscribe -np " + std::to_string(ranks) + " " KEYHOLE_MPI_EXECUTABLE " ";
    }
    int run_ranks(int ranks, const std::string& arguments) { return wait(start_line(mpirun(ranks) + arguments)); }
    void expect_same(const std::string& a, const std::string& b) {
        const Picture one = read_exr(scratch.path(a)), other = read_exr(scratch.path(b));
        for (const auto& [name, image] : one.layers) EXPECT_EQ(image.data, other.layers.at(name).data) << name;
    }
};

class RanksOfAScene : public Ranks, public testing::WithParamInterface<const char*> {};

} // namespace

TEST_P(RanksOfAScene, MakeThePictureThatOneMakes) {
    const std::string render = "render " KEYHOLE_SOURCE_DIR "/scenes/" + std::string(GetParam()) +
                               ".yaml --resolution 24x16 --no-png -q -t 1 --method mps --spp 1 --passes 6 "
                               "--mutations 3k -D chains=50 -D brightness_samples=2000 -D importons=2000 "
                               "-D photon_memory=512KiB -D cache_rays=64 -D brightness_error=0 ";
    ASSERT_EQ(run(render + "-o whole.exr"), 0);
    for (const int ranks : {1, 2, 3, 5}) {
        ASSERT_EQ(run_ranks(ranks, render + "-o a.exr"), 0) << read("err");
        expect_same("whole.exr", "a.exr");
        EXPECT_EQ(read_exr(scratch.path("a.exr")).metadata.at("complete"), "yes");
    }
    for (const auto& [name, range] : {std::pair("b", "0:1"), {"c", "4:6"}, {"d", "1:4"}})
        ASSERT_EQ(run(render + "-o " + name + ".exr --pass-range " + range), 0) << read("err");
    ASSERT_EQ(run("merge b.exr c.exr d.exr -o merged.exr"), 0) << read("err");
    expect_same("whole.exr", "merged.exr");
}

INSTANTIATE_TEST_SUITE_P(Scenes, RanksOfAScene, testing::Values("box", "rooms", "lantern"),
                         [](const auto& info) { return std::string(info.param); });

class RanksOfAPass : public Ranks, public testing::WithParamInterface<const char*> {};

TEST_P(RanksOfAPass, MakeThePictureThatOneMakes) {
    const std::string render = "render scene.yaml --no-png -q -t 1 --passes 2 --spp 3 --mutations 30k -D chains=100 "
                               "-D chain_groups=4 -D brightness_samples=5000 -D importons=5000 -D light_paths=20k "
                               "-D photon_memory=512KiB --method " +
                               std::string(GetParam()) + " ";
    ASSERT_EQ(run(render + "-o whole.exr"), 0);
    ASSERT_EQ(run_ranks(3, render + "-o a.exr"), 0) << read("err");
    expect_same("whole.exr", "a.exr");
    EXPECT_EQ(read_exr(scratch.path("a.exr")).metadata.at("complete"), "yes");
}

INSTANTIATE_TEST_SUITE_P(Methods, RanksOfAPass,
                         testing::Values("mps", "ipm", "pm", "auto", "mlt", "pssmlt", "mmlt", "rjmlt", "bdpt"),
                         [](const auto& info) { return std::string(info.param); });

TEST_F(Ranks, RunWhatIsNoRender) {
    EXPECT_EQ(run_ranks(2, "render none.yaml"), 2);
    EXPECT_EQ(run_ranks(3, "render scene.yaml --no-png --passes 3 -o a.exr"), 0) << read("err");
    EXPECT_EQ(run_ranks(3, "diff a.exr a.exr"), 0) << read("err");
}

TEST_F(Ranks, EndWhereOneIsSilent) {
    scratch.write("rank", "#!/bin/sh\necho $$ >pid.$OMPI_COMM_WORLD_RANK\nexec " KEYHOLE_MPI_EXECUTABLE " \"$@\"\n");
    const std::string render = "render scene.yaml --no-png -q -t 1 --spp 50 --passes 100 -o a.exr ";
    const pid_t pid =
        start_line("mpirun --oversubscribe -np 3 -x KEYHOLE_MPI_PATIENCE=1 sh ./rank " + render + "--checkpoint 0");
    while (!exists("a.checkpoint.exr") && waitpid(pid, nullptr, WNOHANG) == 0) usleep(1000);
    const pid_t silent = std::stoi(read("pid.2"));
    kill(silent, SIGSTOP);
    EXPECT_EQ(wait(pid), 1);
    EXPECT_THAT(read("err"), HasSubstr("rank 0 has heard nothing of rank 2 on "));
    EXPECT_THAT(read("err"), HasSubstr("go on with --resume"));
    EXPECT_FALSE(exists("a.exr"));
    ASSERT_EQ(run(render + "--resume"), 0) << read("err");
    ASSERT_EQ(run("render scene.yaml --no-png -q --spp 50 --passes 100 -o whole.exr"), 0);
    expect_same("whole.exr", "a.exr");

    setenv("KEYHOLE_MPI_PATIENCE", "long", 1);
    EXPECT_EQ(run_ranks(2, render), 2);
    EXPECT_THAT(read("err"), HasSubstr("KEYHOLE_MPI_PATIENCE: found 'long'"));
    unsetenv("KEYHOLE_MPI_PATIENCE");
}

/// Where a pass is done by all of them, the others wait for the silent one at the next exchange.
TEST_F(Ranks, EndAPassOfAllWhereOneIsSilent) {
    scratch.write("rank", "#!/bin/sh\necho $$ >pid.$OMPI_COMM_WORLD_RANK\nexec " KEYHOLE_MPI_EXECUTABLE " \"$@\"\n");
    const std::string render =
        "render scene.yaml --no-png -q -t 1 --method ipm --spp 100 --passes 2 -D light_paths=20k "
        "-D importons=5k -D photon_memory=512KiB ";
    const pid_t pid = start_line("mpirun --oversubscribe -np 3 -x KEYHOLE_MPI_PATIENCE=1 sh ./rank " + render +
                                 "-o a.exr --checkpoint 0");
    while (!exists("a.checkpoint.exr") && waitpid(pid, nullptr, WNOHANG) == 0) usleep(1000);
    kill(std::stoi(read("pid.2")), SIGSTOP);
    EXPECT_EQ(wait(pid), 1);
    EXPECT_THAT(read("err"), HasSubstr("rank 0 has heard nothing of rank 2 on "));
    ASSERT_EQ(run_ranks(3, render + "-o a.exr --resume"), 0) << read("err");
    ASSERT_EQ(run(render + "-o whole.exr"), 0);
    expect_same("whole.exr", "a.exr");
}

TEST_F(Ranks, KilledGoOnWithAnotherNumberOfThem) {
    const std::string render = "render scene.yaml --no-png -t 1 --spp 10 --passes 60 --checkpoint 0 -o a.exr ";
    ASSERT_EQ(run("render scene.yaml --no-png --spp 10 --passes 60 -o whole.exr"), 0);
    const pid_t pid = start_line(mpirun(3) + render);
    while (!(exists("a.checkpoint.exr") && exists("a.checkpoint.1.exr") && exists("a.checkpoint.2.exr")) &&
           waitpid(pid, nullptr, WNOHANG) == 0)
        usleep(1000);
    kill(pid, SIGTERM);
    EXPECT_NE(wait(pid), 0);
    ASSERT_EQ(run_ranks(2, render + "--resume"), 0) << read("err");
    expect_same("whole.exr", "a.exr");
}
