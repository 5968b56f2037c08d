// keyhole paths: tools for user paths.
#include "cli/paths/paths.h"

#include "cli/resolution.h"
#include "core/error.h"

namespace keyhole {

SceneWithPaths load_with_paths(const std::string& scene, const std::string& user_paths,
                               const std::vector<std::string>& overrides, const std::string& resolution) {
    LoadedScene loaded = load(scene, overrides);
    if (!resolution.empty()) set_resolution(loaded.description.window, resolution);
    SceneWithPaths all{nullptr, loaded.settings, std::move(loaded.user_paths)};
    if (!user_paths.empty()) all.user_paths = load_user_paths(user_paths);
    if (all.user_paths.paths.empty())
        throw InputError(scene + ": found a scene without user paths, expected a file of them as second argument");
    all.scene = std::make_unique<Scene>(std::move(loaded.description));
    return all;
}

void add_paths_command(CLI::App& app, Action& action) {
    CLI::App* paths = app.add_subcommand("paths", "Check, show, suggest and trace user paths");
    paths->require_subcommand(1);
    add_paths_check_command(*paths, action);
    add_paths_show_command(*paths, action);
    add_paths_suggest_command(*paths, action);
    add_paths_trace_command(*paths, action);
}

} // namespace keyhole
