// Runs the program from outside.
#pragma once

#include "support/scratch_directory.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <spawn.h>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace keyhole {

inline constexpr const char* kScene =
    "film: {resolution: [24, 16]}\n"
    "camera: {from: [0, 0, 3], to: [0, 0, 0]}\n"
    "materials: {white: {type: diffuse}}\n"
    "shapes:\n"
    "  - {type: sphere, material: white}\n"
    "  - {type: rectangle, corner: [-1, 3, -1], u: [2, 0, 0], v: [0, 0, 2], emission: {power: 60}}\n"
    "render: {method: path, spp: 2}\n";

class Program : public testing::Test {
  protected:
    Program() { scratch.write("scene.yaml", kScene); }

    /// Starts the program in the scratch directory.
    pid_t start(const std::string& arguments) { return start_line(KEYHOLE_EXECUTABLE " " + arguments); }
    /// Starts another one there.
    pid_t start_line(const std::string& command) {
        const std::string line = "cd '" + scratch.path("") + "' && exec " + command + " >out 2>err";
        std::array<const char*, 4> argv{"sh", "-c", line.c_str(), nullptr};
        pid_t pid = 0;
        EXPECT_EQ(posix_spawn(&pid, "/bin/sh", nullptr, nullptr, const_cast<char**>(argv.data()), environ), 0);
        return pid;
    }
    int wait(pid_t pid) {
        int status = 0;
        waitpid(pid, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    int run(const std::string& arguments) { return wait(start(arguments)); }
    std::string read(const std::string& name) const {
        std::ostringstream text;
        text << std::ifstream(scratch.path(name)).rdbuf();
        return text.str();
    }
    bool exists(const std::string& name) const { return std::filesystem::exists(scratch.path(name)); }

    ScratchDirectory scratch;
};

} // namespace keyhole
