// 2,000 inputs with mistakes in them: the program renders a picture of finite
// numbers, or says what is wrong and exits with 2. Each runs in a process of
// its own.
#include "cli/program.h"
#include "core/settings.h"
#include "film/files/exr.h"
#include "methods/method.h"
#include "support/mutation.h"
#include "support/scratch_directory.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <iostream>
#include <map>
#include <sstream>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

namespace keyhole {
namespace {

namespace fs = std::filesystem;
using test::Dice;

constexpr int kNotFinite = 77;     // exit codes of ours
constexpr rlim_t kMostSeconds = 5; // of CPU time, which other processes don't lengthen

constexpr const char* kMeshScene = "film: {resolution: [8, 6]}\n"
                                   "camera: {from: [0, 1, 4], to: [0, 0, 0]}\n"
                                   "materials: {white: {type: diffuse}}\n"
                                   "emitters: [{type: environment}]\n"
                                   "shapes: [{type: mesh, file: MESH, material: white, smooth: true}, {type: "
                                   "sphere, emission: {power: 9}}]\n";
constexpr const char* kTextureScene = "film: {resolution: [8, 6]}\n"
                                      "camera: {from: [0, 1, 4], to: [0, 0, 0]}\n"
                                      "materials: {a: {type: diffuse, reflectance: {type: image, file: "
                                      "ramp.jpg}}}\n"
                                      "shapes:\n"
                                      "  - {type: rectangle, corner: [-1, -1, 0], u: [2, 0, 0], v: [0, 2, 0], "
                                      "material: a}\n"
                                      "  - {type: sphere, center: [0, 3, 1], radius: 0.3, emission: {power: "
                                      "9}}\n";

std::string read(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// Files to make mistakes in, in a directory where they find what they include.
class Inputs {
  public:
    Inputs() {
        const fs::path source = KEYHOLE_SOURCE_DIR;
        fs::copy(source / "scenes/failures", scratch_.path(""));
        for (const char* file : {"ball", "box", "disco", "egg", "glossy", "tube", "lantern"})
            fs::copy(source / "scenes" / (std::string(file) + ".yaml"), scratch_.path(""));
        fs::create_directory_symlink(source / "scenes/meshes", scratch_.path("meshes"));
        fs::copy(source / "tests/data/pbrt", scratch_.path(""));
        for (const char* file : {"quad.obj", "tent.ply", "two_placements.gltf", "ramp.jpg"})
            fs::copy(source / "tests/data" / file, scratch_.path(""));
        fs::copy(source / "userpaths/box.yaml", scratch_.path("paths.yaml"));
        scratch_.write("texture.yaml", kTextureScene);
        for (const auto& entry : fs::directory_iterator(scratch_.path("")))
            if (entry.path().extension() == ".yaml" && entry.path().stem() != "paths" && entry.path().stem() != "room")
                scenes_.push_back(entry.path().filename().string());
        std::sort(scenes_.begin(), scenes_.end());
        visit_settings(settings_, [&](const char* key, const auto&...) { keys_.emplace_back(key); });
    }

    /// Makes the input of that number, and the arguments to run the program with.
    std::vector<std::string> make(std::uint64_t number, std::string& kind) {
        Dice dice(number + 1);
        scene_ = scenes_[dice.below(scenes_.size())];
        std::vector<std::string> more;
        switch (number % 10) {
        case 0:
            kind = "user paths";
            user_paths(dice, more);
            break;
        case 1:
        case 2:
            kind = "pbrt";
            pbrt(dice);
            break;
        case 3:
        case 4:
            kind = "meshes";
            mesh(dice);
            break;
        case 5:
            kind = "textures";
            texture(dice);
            break;
        case 6:
        case 7:
            kind = "settings";
            settings(dice, more);
            break;
        default:
            kind = "scenes";
            scene(dice);
        }
        std::vector<std::string> arguments{"keyhole",
                                           "render",
                                           scratch_.path(scene_),
                                           "-o",
                                           scratch_.path("a.exr"),
                                           "--png",
                                           scratch_.path("a.png"),
                                           "-t",
                                           "1",
                                           "-q",
                                           "--resolution",
                                           "8x6"};
        for (const std::string& setting :
             {fmt::format("method={}", dice.of(all_methods())->name), std::string("spp=1"), std::string("passes=1"),
              std::string("mutations=300"), std::string("light_paths=300"), std::string("chains=10"),
              std::string("brightness_samples=1000"), std::string("importons=1000"),
              std::string("photon_memory=512KiB"), std::string("cache_rays=16")})
            arguments.insert(arguments.end(), {"-D", setting});
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }

    const ScratchDirectory& scratch() const { return scratch_; }

  private:
    void scene(Dice& dice) {
        const std::string text = test::mistaken_text(read(scratch_.path(scene_)), dice);
        scratch_.write(scene_ = "mistaken.yaml", text);
    }
    void user_paths(Dice& dice, std::vector<std::string>& more) {
        scene_ = "box.yaml";
        scratch_.write("mistaken_paths.yaml", test::mistaken_text(read(scratch_.path("paths.yaml")), dice));
        more = {"--user-paths", scratch_.path("mistaken_paths.yaml")};
    }
    void pbrt(Dice& dice) {
        const std::string text = test::mistaken_text(read(scratch_.path("room.pbrt")), dice);
        scratch_.write(scene_ = "mistaken.pbrt", text);
    }
    void mesh(Dice& dice) {
        constexpr std::array<const char*, 4> kMeshes{"quad.obj", "tent.ply", "two_placements.gltf", "triangle.ply"};
        const std::string name = kMeshes[dice.below(kMeshes.size())], bytes = read(scratch_.path(name));
        const std::string broken = "mistaken_" + name;
        scratch_.write(broken,
                       dice.below(2) > 0 ? test::mistaken_text(bytes, dice) : test::mistaken_bytes(bytes, dice));
        std::string text = kMeshScene;
        scratch_.write(scene_ = "mistaken.yaml", text.replace(text.find("MESH"), 4, broken));
    }
    void texture(Dice& dice) {
        scratch_.write("mistaken.jpg", test::mistaken_bytes(read(scratch_.path("ramp.jpg")), dice));
        std::string text = kTextureScene;
        scratch_.write(scene_ = "mistaken.yaml", text.replace(text.find("ramp.jpg"), 8, "mistaken.jpg"));
    }
    void settings(Dice& dice, std::vector<std::string>& more) {
        constexpr std::array<const char*, 8> kOptions{"--resolution", "--spp",        "--seed",    "--photon-memory",
                                                      "--passes",     "--pass-range", "--quality", "--target-error"};
        for (std::size_t n = 1 + dice.below(2); n > 0; --n) {
            const std::string value = test::bad_value(dice);
            if (dice.below(4) == 0)
                more.push_back(kOptions[dice.below(kOptions.size())] + ("=" + value));
            else
                more.insert(more.end(), {"-D", keys_[dice.below(keys_.size())] + "=" + value});
        }
    }

    ScratchDirectory scratch_;
    Settings settings_;
    std::vector<std::string> scenes_, keys_;
    std::string scene_;
};

/// In the child: runs the program and looks at the picture. Work that is asked
/// for in earnest, by settings, is broken off by Ctrl-C after a quarter of a second.
[[noreturn]] void run(std::vector<std::string> arguments, const ScratchDirectory& scratch) {
    const int err = open(scratch.path("err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(err, STDERR_FILENO);
    dup2(err, STDOUT_FILENO);
    const rlimit seconds{kMostSeconds, kMostSeconds + 1};
    setrlimit(RLIMIT_CPU, &seconds);
    std::signal(SIGINT, SIG_IGN); // once the program is done it is too late for Ctrl-C
    std::signal(SIGPROF, [](int) { std::raise(SIGINT); });
    const itimerval timer{{}, {0, 250'000}};
    setitimer(ITIMER_PROF, &timer, nullptr);
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    const int code = run_program(static_cast<int>(argv.size()), argv.data(), nullptr);
    const std::string exr = scratch.path("a.exr");
    if (code != kBadInput && fs::exists(exr))
        for (const auto& [name, image] : read_exr(exr).layers)
            for (const float x : image.data)
                if (!std::isfinite(x)) _exit(kNotFinite);
    _exit(code);
}

} // namespace

TEST(Mutated_Inputs, AreRenderedOrRefused) {
    std::uint64_t first = 0, end = 2000;
    if (const char* range = std::getenv("KEYHOLE_INPUTS")) std::sscanf(range, "%lu:%lu", &first, &end); // others
    Inputs inputs;
    std::map<std::string, std::map<int, int>> figures; // kind, exit code
    double slowest = 0;
    for (std::uint64_t i = first; i < end; ++i) {
        std::string kind;
        const auto arguments = inputs.make(i, kind);
        for (const char* file : {"a.exr", "a.png"}) fs::remove(inputs.scratch().path(file));
        const pid_t pid = fork();
        if (pid == 0) run(arguments, inputs.scratch());
        int status = 0;
        rusage usage{};
        wait4(pid, &status, 0, &usage);
        const double seconds = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                               1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
        slowest = std::max(slowest, seconds);
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        ++figures[kind][code];
        const std::string said = read(inputs.scratch().path("err"));
        std::string line;
        for (const std::string& a : arguments) line += a + " ";
        const bool good = code == kSuccess || code == kBadInput || code == kInterrupted;
        EXPECT_TRUE(good && seconds < kMostSeconds)
            << kind << " number " << i << ": exit code " << code << ", " << seconds << " s: " << said << line << "\n"
            << read(arguments[2]);
        EXPECT_TRUE(code != kBadInput || said.starts_with("keyhole: ")) << kind << " number " << i << ": " << said;
    }
    for (const auto& [kind, codes] : figures) {
        std::cout << kind << ":";
        for (const auto& [code, n] : codes) std::cout << "  exit code " << code << ": " << n;
        std::cout << "\n";
    }
    std::cout << "slowest: " << slowest << " s of CPU time\n";
}

} // namespace keyhole
