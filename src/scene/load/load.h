// Scenes from files of any format that we read.
#pragma once

#include "core/settings.h"
#include "scene/load/yaml/settings_text.h"
#include "scene/load/yaml/user_path_file.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace keyhole {

/// What a scene file says.
struct LoadedScene {
    SceneDescription description;
    Settings settings;
    UserPathFile user_paths;   ///< of the file that the scene names; none otherwise
    std::size_t instances = 0; ///< groups or objects placed, counted as often as they are
};

/// Reads a scene: pbrt's format where the path ends in .pbrt, glTF where in .gltf or .glb, else YAML.
/// @param overrides `key=value` settings, applied in order after those of the file.
/// @param warnings receives what isn't read as it is meant, one line each; may be null, as below.
/// @throws InputErrors with "file:line:column: what was found, what was expected" for every mistake in the files, as
/// far as it is independent of those before.
LoadedScene load(const std::string& path, const std::vector<std::string>& overrides = {},
                 std::vector<std::string>* warnings = nullptr);

/// The same for a scene file in YAML (docs/scene-format.md), the files it includes and its meshes.
LoadedScene load_scene(const std::string& path, const std::vector<std::string>& overrides = {},
                       std::vector<std::string>* warnings = nullptr);

/// Whether a path ends in .pbrt.
bool is_pbrt(const std::string& path);

/// Reads a scene in the format of pbrt-v4, and most of v3's, with all files that it names (docs/pbrt.md).
/// @param warnings receives "file:line:column: directive: what is done instead", once for each kind.
/// @param settings those that the file's sampler and integrator then overrule.
/// @throws InputErrors as load(), for what the picture would be wrong without, too.
LoadedScene load_pbrt(const std::string& path, std::vector<std::string>* warnings, const Settings& settings = {});

/// Whether a path ends in .gltf or .glb.
bool is_gltf(const std::string& path);

/// Reads the default scene of a glTF 2.0 file (Khronos 2021; docs/gltf.md): meshes, materials, textures, the first
/// camera, and the lights of KHR_lights_punctual. Without a camera one is placed that sees everything, and without any
/// light there is a white sky; both with a warning.
/// @param warnings receives "path: what is read otherwise than it is meant", each once.
/// @throws InputError "path: what was found, what was expected" for files that are missing or broken.
LoadedScene load_gltf(const std::string& path, std::vector<std::string>* warnings);

/// The bytes of a glTF file as Assimp reads them rightly: gltf/importable.h.
/// @throws InputError as load_gltf().
std::string importable_gltf(const std::string& path);

} // namespace keyhole
