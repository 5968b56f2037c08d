// keyhole paths check: whether user paths work in a scene, one line each.
#include "cli/paths/paths.h"
#include "core/error.h"
#include "sampling/guidance/user_paths.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyhole {
namespace {

struct CheckOptions {
    std::string scene, paths;
};

/// Largest distance from a given point to the one that was found [m].
double largest_miss(const UserPathSpec& spec, const UserPath& path) {
    double most = (Imath::V3d(path.patch.center().p) - spec.points[0].p).length();
    for (std::size_t i = 0; i < path.vertices.size(); ++i)
        if (!path.vertices[i].bounce)
            most = std::max(most, (Imath::V3d(path.vertices[i].p) - spec.points[i + 1].p).length());
    return most;
}

int check(const CheckOptions& options) {
    const SceneWithPaths all = load_with_paths(options.scene, options.paths);
    std::size_t widest = 4, bad = 0;
    for (const UserPathSpec& spec : all.user_paths.paths) widest = std::max(widest, spec.name.size());
    std::string first;
    fmt::print("{:<{}}  {:>6}  {:>9}  {:<14}  {}\n", "path", widest, "weight", "snapped", "vertices", "joined to");
    for (const UserPathSpec& spec : all.user_paths.paths) {
        try {
            const UserPath path = bind_user_path(*all.scene, spec);
            fmt::print("{:<{}}  {:>6.3g}  {:>7.1f}mm  {:<14}  {}\n", spec.name, widest, spec.weight,
                       1000 * largest_miss(spec, path), path.signature(),
                       path.seen ? "the current path, or the eye" : "the current path");
        } catch (const InputError& e) {
            fmt::print("{:<{}}  {}\n", spec.name, widest, e.what());
            if (bad++ == 0) first = e.what();
        }
    }
    if (bad == 0) return kSuccess;
    throw InputError(bad == 1 ? first : fmt::format("{} (and {} more)", first, bad - 1));
}

} // namespace

void add_paths_check_command(CLI::App& paths, Action& action) {
    CLI::App* command = paths.add_subcommand("check", "Say whether user paths work in a scene");
    auto o = std::make_shared<CheckOptions>();
    command->add_option("SCENE", o->scene, "scene file")->required();
    command->add_option("PATHS", o->paths, "file of user paths; default: the scene's");
    command->callback([&action, o] { action = [o] { return check(*o); }; });
}

} // namespace keyhole
