#include "scene/load/load.h"

namespace keyhole {

LoadedScene load(const std::string& path, const std::vector<std::string>& overrides,
                 std::vector<std::string>* warnings) {
    if (!is_pbrt(path) && !is_gltf(path)) return load_scene(path, overrides, warnings);
    LoadedScene scene = is_pbrt(path) ? load_pbrt(path, warnings) : load_gltf(path, warnings);
    for (const auto& o : overrides) apply_override(scene.settings, o, warnings);
    return scene;
}

} // namespace keyhole
