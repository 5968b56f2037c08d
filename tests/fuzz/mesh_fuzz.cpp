// Feeds the readers of meshes with junk (libFuzzer): they may throw InputError and nothing else. The first byte chooses
// the format.
// build-fuzz/tests/mesh_fuzz CORPUS tests/data/meshes
#include "junk_file.h"
#include "scene/load/load_mesh.h"

#include <array>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    constexpr std::array<const char*, 4> kFormats{".ply", ".obj", ".gltf", ".glb"};
    return keyhole::survive(
        [&] { keyhole::import_mesh(keyhole::junk_file(data + 1, size - 1, kFormats[data[0] % kFormats.size()])); });
}
