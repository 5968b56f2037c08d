// Feeds the reader of scene files with junk (libFuzzer): it may throw InputError and nothing else. What can be read is
// built as for a render, if it is small.
// build-fuzz/tests/scene_fuzz CORPUS scenes/failures
#include "junk_file.h"
#include "scene/geometry.h"
#include "scene/load/load.h"
#include "scene/load/load_mesh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return keyhole::survive([&] {
        keyhole::LoadedScene loaded = keyhole::load(keyhole::junk_file(data, size, ".yaml"));
        std::size_t triangles = 0; // spheres that are stretched become thousands
        for (const keyhole::Shape& shape : loaded.description.shapes) triangles += keyhole::triangle_count(shape);
        if (loaded.instances < 1000 && triangles < 200'000) keyhole::Scene(std::move(loaded.description));
    });
}
