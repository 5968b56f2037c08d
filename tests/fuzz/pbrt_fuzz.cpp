// Feeds the importer of pbrt's format with junk (libFuzzer): it may throw InputError and nothing else.
// cmake --preset fuzz && cmake --build --preset fuzz && build-fuzz/tests/pbrt_fuzz CORPUS tests/data/pbrt
#include "junk_file.h"
#include "scene/load/pbrt/importer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return keyhole::survive([&] {
        std::vector<std::string> warnings;
        keyhole::pbrt::Importer importer(keyhole::junk_file(data, size, ".pbrt"), &warnings, {});
        importer.run();
        importer.take_description();
    });
}
