// What the program does when what it writes to fails: never a render that is lost, never a signal.
#include "film/files/exr.h"
#include "support/program.h"
#include "support/sanitizers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

using namespace keyhole;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

namespace {

class Faults : public Program {
  protected:
    /// Runs a line of shell, in which $K is the program; returns its exit code.
    int shell(const std::string& line) {
        scratch.write("line.sh", "K=" KEYHOLE_EXECUTABLE "\n" + line + "\n");
        return wait(start_line("sh line.sh"));
    }
    /// Whether the picture of kScene is there, whole.
    void expect_picture(const std::string& name) const {
        ASSERT_TRUE(exists(name));
        const Picture picture = read_exr(scratch.path(name));
        EXPECT_EQ(picture.width, 24);
        EXPECT_EQ(picture.metadata.at("complete"), "yes");
    }
    void expect_no_temporary_files() const {
        for (const auto& file : std::filesystem::directory_iterator(scratch.path("")))
            EXPECT_THAT(file.path().filename().string(), Not(testing::EndsWith(".tmp")));
    }
};

constexpr const char* kRender = "$K render scene.yaml -o a.exr --passes 4";

} // namespace

TEST_F(Faults, MessagesThatNobodyReadsEndNoRender) {
    const std::string render = kRender;
    ASSERT_EQ(shell("{ " + render + "; echo $? >code; } 2>&1 | true"), 0);
    EXPECT_EQ(read("code"), "0\n");
    expect_picture("a.exr");
}

TEST_F(Faults, MessagesToAFullDiskEndNoRender) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
    EXPECT_EQ(shell(std::string(kRender) + " -v 2>/dev/full"), 0);
    expect_picture("a.exr");
}

TEST_F(Faults, ClosedStreamsDontGetIntoThePicture) {
    EXPECT_EQ(shell(std::string(kRender) + " -v <&- >&- 2>&-"), 0);
    expect_picture("a.exr");
}

TEST_F(Faults, AFileThatMayNotGrowIsAnErrorAndTheOldOneStays) {
    ASSERT_EQ(run("render scene.yaml -q --no-png -o a.exr"), 0);
    const std::string before = read("a.exr");
    ASSERT_GT(before.size(), 4096u);
    EXPECT_EQ(shell("ulimit -f 4; " + std::string(kRender) + " -q --no-png --seed 2"), 2); // blocks of 512 bytes
    EXPECT_THAT(read("err"), HasSubstr("a.exr: cannot write: File too large"));
    EXPECT_EQ(read("a.exr"), before);
    expect_no_temporary_files();
}

TEST_F(Faults, APhotonMapThatMayNotGrowIsAnErrorAndThePictureStays) {
    EXPECT_EQ(shell("ulimit -f 200; $K render " KEYHOLE_SOURCE_DIR "/scenes/box.yaml --method ipm -q --no-png -o a.exr "
                    "--save-map a.kmap --resolution 24x16 -D light_paths=20k -D photons=20k"),
              2);
    EXPECT_THAT(read("err"), HasSubstr("a.kmap: cannot write: File too large"));
    EXPECT_FALSE(exists("a.kmap"));
    expect_picture("a.exr");
    expect_no_temporary_files();
}

TEST_F(Faults, FoldersThatAreNotThereAreToldBeforeAnythingIsRendered) {
    for (const char* output : {"-o no/a.exr", "-o a.exr --stats no/a.json", "-o scene.yaml/a.exr",
                               "-o a.exr --method ipm --save-map no/a.kmap"}) {
        EXPECT_EQ(run(std::string("render scene.yaml ") + output), 2) << output;
        EXPECT_THAT(read("err"), HasSubstr("cannot write")) << output;
        EXPECT_THAT(read("err"), Not(HasSubstr("samples"))) << output;
    }
}

TEST_F(Faults, TooLittleMemoryIsAnErrorThatSaysSo) {
    if (test::kSanitized) GTEST_SKIP() << "sanitizers take all addresses that there are";
    int errors = 0, pictures = 0;
    for (int mebibytes = 150; mebibytes <= 900; mebibytes += 150) {
        const int code = shell("ulimit -v " + std::to_string(1024 * mebibytes) +
                               "; $K render scene.yaml -q --no-png --resolution 640x480 --spp 1 -t 2 -o a.exr");
        if (code == 0) {
            ++pictures;
            continue;
        }
        ++errors;
        EXPECT_EQ(code, 2) << mebibytes << " MiB: " << read("err");
        EXPECT_THAT(read("err"), HasSubstr("not enough memory")) << mebibytes << " MiB";
        EXPECT_FALSE(exists("a.exr"));
    }
    EXPECT_GT(errors, 0);
    EXPECT_GT(pictures, 0);
    expect_no_temporary_files();
}

TEST_F(Faults, MemoryThatPhotonsMayTakeNeedntBeThere) {
    if (test::kSanitized) GTEST_SKIP() << "sanitizers take all addresses that there are";
    EXPECT_EQ(run("render scene.yaml -q --no-png --method ipm -D light_paths=3k -D importons=1k -D plan=all "
                  "--photon-memory 8000GiB -o a.exr"),
              0)
        << read("err");
}

TEST_F(Faults, ReadersOfTheOutputMayGo) {
    EXPECT_EQ(shell("{ $K info scene.yaml; echo $? >code; } | true"), 0);
    EXPECT_EQ(read("code"), "1\n");
    EXPECT_THAT(read("err"), IsEmpty());
    if (!std::filesystem::exists("/dev/full")) return;
    EXPECT_EQ(shell("$K info scene.yaml >/dev/full"), 1);
    EXPECT_THAT(read("err"), HasSubstr("cannot write to the standard output"));
}
