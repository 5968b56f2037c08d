// Scenes of pbrt's format for tests, from strings.
#pragma once

#include "core/error.h"
#include "scene/load/load.h"
#include "support/scratch_directory.h"

#include <string>
#include <vector>

namespace keyhole {

/// A scene whose world is `world`, preceded by a film of 8 x 6 pixels and `options`.
struct PbrtScene {
    explicit PbrtScene(const std::string& world, const std::string& options = "") {
        const ScratchDirectory directory;
        const std::string path =
            directory.write("scene.pbrt", "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 6\n" +
                                              options + "\nWorldBegin\n" + world);
        scene = load_pbrt(path, &warnings);
    }

    const Shape& shape(std::size_t i = 0) const { return scene.description.shapes.at(i); }
    const TriangleMesh& mesh(std::size_t i = 0) const { return std::get<TriangleMesh>(shape(i).geometry); }
    const Sphere& sphere(std::size_t i = 0) const { return std::get<Sphere>(shape(i).geometry); }
    const Emitter& emitter(std::size_t i = 0) const { return *scene.description.emitters.at(i); }

    LoadedScene scene;
    std::vector<std::string> warnings;
};

/// What reading such a scene fails with; empty where it doesn't.
inline std::string pbrt_error(const std::string& world, const std::string& options = "") {
    try {
        PbrtScene(world, options);
    } catch (const InputError& e) {
        return e.what();
    }
    return "";
}

inline const std::string kPbrtTriangle = "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0  1 0 0  0 1 0 ]\n";

} // namespace keyhole
