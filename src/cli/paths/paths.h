// What the subcommands of `keyhole paths` share.
#pragma once

#include "cli/command.h"
#include "scene/load/load.h"

#include <string>

namespace keyhole {

/// A scene, and the user paths for it.
struct SceneWithPaths {
    std::unique_ptr<Scene> scene;
    Settings settings;
    UserPathFile user_paths;
};

/// Reads a scene and a file of user paths; empty: the one that the scene names. `overrides` are settings, `resolution`
/// is WIDTHxHEIGHT or empty. @throws InputError for mistakes in either, and if there are no user paths at all.
SceneWithPaths load_with_paths(const std::string& scene, const std::string& user_paths,
                               const std::vector<std::string>& overrides = {}, const std::string& resolution = "");

/// Each adds its subcommand to `paths`.
void add_paths_check_command(CLI::App& paths, Action& action);
void add_paths_show_command(CLI::App& paths, Action& action);
void add_paths_suggest_command(CLI::App& paths, Action& action);
void add_paths_trace_command(CLI::App& paths, Action& action);

} // namespace keyhole
