#include "scene/load/load.h"

#include "scene/load/pbrt/importer.h"

namespace keyhole {

bool is_pbrt(const std::string& path) { return path.ends_with(".pbrt"); }

LoadedScene load_pbrt(const std::string& path, std::vector<std::string>* warnings, const Settings& settings) {
    pbrt::Importer importer(path, warnings, settings);
    importer.run();
    LoadedScene scene;
    scene.description = importer.take_description();
    scene.settings = importer.settings();
    scene.instances = importer.instances();
    return scene;
}

} // namespace keyhole
