#include "scene/load/load.h"

#include "scene/load/load_pbrt.h"

namespace keyhole {

LoadedScene load(const std::string& path, const std::vector<std::string>& overrides,
                 std::vector<std::string>* warnings) {
    if (!is_pbrt(path)) return load_scene(path, overrides, warnings);
    LoadedScene scene = load_pbrt(path, warnings);
    for (const auto& o : overrides) apply_override(scene.settings, o, warnings);
    return scene;
}

} // namespace keyhole
