// keyhole inspect: a page that shows where the light goes.
#include "cli/inspect/page_data.h"
#include "cli/page/page_parts.h"
#include "cli/pictures/files_apart.h"
#include "cli/program.h"
#include "cli/progress/interrupt.h"
#include "cli/progress/terminal_progress.h"
#include "cli/words/report.h"
#include "cli/words/tell.h"
#include "core/error.h"
#include "core/parallel.h"
#include "film/files/atomic_file.h"
#include "methods/choice/effort.h"
#include "methods/method.h"
#include "scene/load/load.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <set>

namespace keyhole {
namespace {

struct InspectOptions {
    std::string scene, output, user_paths, resolution, save_map;
    std::vector<std::string> overrides;
    InspectionLimits limits;
    int threads = 0;
};

/// What people call it: many scenes are a file of the same name in a folder of their own.
std::string name_of(const std::filesystem::path& file) {
    const std::string name = file.stem().string(), folder = std::filesystem::absolute(file).parent_path().filename();
    return (name == "scene" || name == "main") && !folder.empty() ? folder : name;
}

/// A picture of about so many pixels: what a page can hold of each.
constexpr double kPixels = 22'000, kMostPixels = 100'000;

void choose_resolution(ImageWindow& window, const std::string& given) {
    if (!given.empty()) {
        set_resolution(window, given);
        if (window.size() > kMostPixels)
            throw InputError(fmt::format("found --resolution {}, expected at most {:.0f} pixels: the page holds what "
                                         "each of them sees",
                                         given, kMostPixels));
        return;
    }
    const double shrink = std::min(1.0, std::sqrt(kPixels / window.size()));
    window.width = std::max(1, static_cast<int>(std::lround(window.width * shrink)));
    window.height = std::max(1, static_cast<int>(std::lround(window.height * shrink)));
}

/// A draft, by photons: what a scene asks for, with what the user says on top.
Settings preview_settings(const Settings& settings, const std::vector<std::string>& overrides) {
    std::set<std::string> named{"passes"};
    for (const std::string& o : overrides) named.insert(o.substr(0, o.find('=')));
    Settings s = with_quality(settings, Quality::draft, named);
    if (!named.contains("spp")) s.spp = std::max<std::int64_t>(1, s.spp / 2); // there are two renders
    s.passes = 1;
    s.target_error = 0;
    if (!s.method->keeps_photons && !named.contains("method")) s.method = &methods::ipm;
    if (s.method == &methods::automatic) s.method = &methods::ipm;
    return s;
}

int run(InspectOptions o) {
    const std::string name = name_of(o.scene);
    if (o.output.empty()) o.output = name + ".html";
    check_writable(o.output);
    const std::vector<NamedFile> outputs{{"--output", o.output}, {"--save-map", o.save_map}};
    std::vector<std::string> load_warnings;
    LoadedScene loaded = load(o.scene, o.overrides, &load_warnings);
    if (!o.user_paths.empty()) loaded.user_paths = load_user_paths(o.user_paths);
    check_apart(outputs, files_of_scene());
    choose_resolution(loaded.description.window, o.resolution);
    Settings settings = preview_settings(loaded.settings, o.overrides);
    settings.save_map = o.save_map;
    StopToken stop;
    const InterruptHandler interrupts(stop);
    const auto progress = progress_on_stderr(stop); // of renders that may take a minute
    RunContext context{&stop, progress.get()};
    std::string page;
    std::optional<std::string> unsaved;
    with_threads(o.threads, [&] {
        Scene scene(std::move(loaded.description));
        UserPathFile working = loaded.user_paths;
        std::erase_if(working.paths, [&](const UserPathSpec& path) { return !binds(scene, path); });
        const UserPaths paths = bind_user_paths(scene, working);
        const auto start = std::chrono::steady_clock::now();
        Inspection inspection = inspect_scene(scene, settings, paths, o.limits, context);
        for (const std::string& warning : load_warnings) inspection.render.stats.warn(Doubt::scene, warning);
        unsaved = inspection.render.stats.unsaved;
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        page = kInspectionPage.with(json_line(page_data(scene, inspection, {name, took.count(), loaded.user_paths})));
    });
    if (stop.requested()) return kInterrupted;
    write_file_atomically(o.output, page);
    tell("{}: {:.1f} MB\n", o.output, 1e-6 * static_cast<double>(page.size()));
    if (unsaved) throw InputError(*unsaved);
    return kSuccess;
}

} // namespace

void add_inspect_command(CLI::App& app, Action& action) {
    CLI::App* command = app.add_subcommand("inspect", "Show where the light goes, on a page in 3-D");
    auto o = std::make_shared<InspectOptions>();
    command->add_option("SCENE", o->scene, "scene file (YAML, or .pbrt)")->required();
    command->add_option("-o,--output", o->output, "page to write (.html); default: the scene's name, in this folder");
    command->add_option("--user-paths", o->user_paths, "user paths, instead of the scene's");
    command->add_option("--resolution", o->resolution, "WIDTHxHEIGHT in pixels; default: about 22,000 of them");
    command->add_option("-D", o->overrides, "any setting of the preview, KEY=VALUE; by default method=ipm")
        ->allow_extra_args(false);
    command->add_option("--photons", o->limits.photons, "most photons on the page")
        ->capture_default_str()
        ->check(CLI::Range(1000, 200'000));
    command->add_option("--triangles", o->limits.triangles, "most triangles on the page; meshes are simplified")
        ->capture_default_str()
        ->check(CLI::Range(1000, 1'000'000));
    command->add_option("--save-map", o->save_map, "write the photons of the preview to this file");
    command->add_option("-t,--threads", o->threads, "threads; 0: one for each core")->check(CLI::Range(0, 4096));
    command->callback([&action, o] { action = [o] { return run(*o); }; });
}

} // namespace keyhole
