// Feeds the importer of pbrt's format with junk (libFuzzer): it may throw InputError and nothing else.
// cmake --preset fuzz && cmake --build --preset fuzz && build-fuzz/tests/pbrt_fuzz CORPUS tests/data/pbrt
#include "core/error.h"
#include "scene/pbrt/importer.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const std::string path =
        (std::filesystem::temp_directory_path() / ("keyhole-fuzz-" + std::to_string(getpid()) + ".pbrt")).string();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    try {
        std::vector<std::string> warnings;
        keyhole::pbrt::Importer importer(path, &warnings, {});
        importer.run();
        importer.take_description();
    } catch (const keyhole::InputError&) {
    }
    return 0;
}
