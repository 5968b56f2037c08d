// What loading a scene costs, beside the least that it could: reading the bytes of its files, and building Embree's
// scene from triangles that are there. Best of some rounds; files lie in the system's cache.
//
// usage: load_bench SCENE [ROUNDS]      on all cores; its files: those beside it and in models/ and textures/ there
#include "scene/accelerator.h"
#include "scene/load/load.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>

namespace {

namespace fs = std::filesystem;

struct Cost {
    double wall = 1e30, cpu = 1e30; ///< seconds; of all threads
};

Cost best(int rounds, const std::function<void()>& work) {
    Cost least;
    for (int i = 0; i < rounds; ++i) {
        const auto wall = std::chrono::steady_clock::now();
        const std::clock_t cpu = std::clock();
        work();
        least.cpu = std::min(least.cpu, static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
        least.wall =
            std::min(least.wall, std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count());
    }
    return least;
}

std::size_t read_folder(const fs::path& folder) {
    std::size_t bytes = 0;
    if (!fs::is_directory(folder)) return bytes;
    std::vector<char> contents;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        contents.resize(entry.file_size());
        std::ifstream(entry.path(), std::ios::binary)
            .read(contents.data(), static_cast<std::streamsize>(contents.size()));
        bytes += contents.size();
    }
    return bytes;
}

void print(const char* what, const Cost& c) { fmt::print("{:<24}{:8.3f} s wall {:8.3f} s cpu\n", what, c.wall, c.cpu); }

} // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: {} SCENE [ROUNDS]\n", argv[0]);
        return 2;
    }
    const std::string path = argv[1];
    const int rounds = argc > 2 ? std::atoi(argv[2]) : 5;
    const fs::path folder = fs::path(path).parent_path();

    std::size_t bytes = 0;
    const Cost reading = best(rounds, [&] {
        bytes = read_folder(folder) + read_folder(folder / "models") + read_folder(folder / "textures");
    });
    const keyhole::Scene scene(keyhole::load(path).description);
    const Cost building = best(rounds, [&] {
        keyhole::Accelerator accelerator(scene.shapes());
        for (std::uint32_t i = 0; i < scene.shapes().size(); ++i) accelerator.attach(i);
        accelerator.commit();
    });
    const Cost loading = best(rounds, [&] { const keyhole::Scene loaded(keyhole::load(path).description); });

    fmt::print("{}: {} bytes, {} shapes\n", path, bytes, scene.shapes().size());
    print("reading bytes", reading);
    print("building Embree's scene", building);
    print("loading", loading);
    fmt::print("loading over the others  {:8.2f}   wall {:8.2f}   cpu\n", loading.wall / (reading.wall + building.wall),
               loading.cpu / (reading.cpu + building.cpu));
    return 0;
}
