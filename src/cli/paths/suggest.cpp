// keyhole paths suggest: user paths from the renderer itself.
#include "cli/paths/paths.h"
#include "cli/real_range.h"
#include "core/error.h"
#include "film/files/atomic_file.h"
#include "methods/render.h"
#include "sampling/guidance/found/find_openings.h"
#include "sampling/guidance/found/suggest_paths.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

constexpr std::int64_t kPathsFromEitherEnd = 8192;

struct SuggestCommand {
    std::string scene, output;
    std::vector<std::string> overrides;
    SuggestOptions options;
};

int suggest(const SuggestCommand& o) {
    LoadedScene loaded = load(o.scene, o.overrides);
    const Scene scene(std::move(loaded.description));
    const StageOneSettings first{.max_scatterings = static_cast<int>(loaded.settings.max_depth),
                                 .samples = loaded.settings.brightness_samples,
                                 .seed = static_cast<std::uint64_t>(loaded.settings.seed)};
    const TransportEnds ends = trace_transport_ends(scene, kPathsFromEitherEnd, first.seed, {});
    UserPathFile file =
        find_openings(scene, ends, {.max_scatterings = first.max_scatterings, .seed = first.seed}, {}).paths;
    // An opening says all that is to be said of light that has to pass it.
    if (file.paths.empty()) file = suggest_user_paths(scene, first, o.options);
    if (file.paths.empty())
        throw InputError(o.scene + ": found no path that carries light to the eye; try -D brightness_samples=...");
    const std::string text =
        user_paths_text(file, "User paths for " + o.scene + ", suggested by keyhole paths suggest");
    if (o.output.empty())
        fmt::print("{}", text);
    else
        write_file_atomically(o.output, text);
    return kSuccess;
}

} // namespace

void add_paths_suggest_command(CLI::App& paths, Action& action) {
    CLI::App* command = paths.add_subcommand("suggest", "Find bright paths that are hard to find");
    auto o = std::make_shared<SuggestCommand>();
    command->add_option("SCENE", o->scene, "scene file")->required();
    command->add_option("-n,--number", o->options.count, "most paths")->check(CLI::Range(1, 1000));
    command->add_option("-o,--output", o->output, "file to write; default: the standard output");
    command->add_option("--radius", o->options.radius, "how far apart paths are alike, as a share of the scene's size")
        ->check(real_range(1e-4, 1.0));
    command->add_option("-D", o->overrides, "any setting of render, KEY=VALUE; may be repeated")
        ->allow_extra_args(false);
    command->callback([&action, o] { action = [o] { return suggest(*o); }; });
}

} // namespace keyhole
