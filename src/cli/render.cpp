// keyhole render: from a scene file to pictures.
#include "cli/checkpoints.h"
#include "cli/pictures/files_apart.h"
#include "cli/pictures/outputs.h"
#include "cli/process_group.h"
#include "cli/program.h"
#include "cli/progress/interrupt.h"
#include "cli/progress/live_view.h"
#include "cli/progress/terminal_progress.h"
#include "cli/setting_options.h"
#include "cli/words/metadata.h"
#include "cli/words/report.h"
#include "cli/words/tell.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/percent.h"
#include "film/files/atomic_file.h"
#include "film/files/exr.h"
#include "film/image_error.h"
#include "methods/choice/effort.h"
#include "methods/choice/first_look.h"
#include "methods/choice/render_in_time.h"
#include "methods/masks.h"
#include "methods/method.h"
#include "methods/photons/photon_file.h"
#include "sampling/guidance/user_paths.h"
#include "sampling/scene_hash.h"
#include "scene/load/load.h"
#include "scene/load/yaml/settings_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

namespace keyhole {
namespace {

struct RenderOptions {
    std::string command_line, scene, resolution, user_paths;
    Outputs outputs;
    Denoising denoising;
    bool no_png = false, quiet = false, verbose = false, strict = false, skip_bad_paths = false;
    std::vector<std::string> overrides; ///< key=value, in the order of the command line
    std::string save_map, load_map;
    Checkpoints checkpoints;
    int threads = 0;
    std::optional<double> timeout, cpu_time; ///< [s]
    std::string quality, display_server;
    ProcessGroup* group = nullptr;         ///< null: this process is alone
    std::optional<double> seconds_of_pass; ///< that one is expected to take, where a time has chosen its settings
    StopToken::Clock::time_point begun = StopToken::Clock::now();

    bool writes() const { return group == nullptr || group->rank() == 0; }
    bool in_time() const { return timeout || cpu_time; }
    /// Whether a time chooses what those that go on from its passes have to keep to.
    bool begins_passes_in_time() const {
        return in_time() && group == nullptr && checkpoints.asked() && checkpoints.pass_range.empty() &&
               load_map.empty() && checkpoints.found(outputs.exr).empty();
    }
};

/// Shares of one render, of which either may hold no unit at all, as one.
Picture join_parts(Picture a, Picture b) {
    if (b.metadata["units"].empty()) return a;
    if (a.metadata["units"].empty()) return b;
    return join_shares(std::array{NamedPicture{"one part", std::move(a)}, NamedPicture{"another part", std::move(b)}});
}

/// Joins what all processes have done, on the first of them.
void join_group(ProcessGroup& group, RenderResult& result, const std::string& checkpoint) {
    Picture all;
    try {
        all = group.collect(std::move(result.picture), join_parts);
    } catch (const ProcessLost& e) {
        throw ProcessLost(fmt::format("{}; {}", e.what(),
                                      checkpoint.empty() ? "nothing is kept without --checkpoint"
                                                         : "what is done is in checkpoints: go on with --resume"));
    }
    if (group.rank() > 0) return;
    result.picture = {};
    if (all.metadata["units"].empty()) return;
    result.picture = join_pictures(std::array{NamedPicture{"all parts", std::move(all)}});
    result.stats.no_samples.reset(); // those of this process' own part, which may have none at all
    const auto& metadata = result.picture.metadata;
    result.stats.complete = metadata.at("complete") == "yes";
    result.stats.samples = std::stod(metadata.at("samples"));
    std::istringstream warnings(metadata.at("warnings"));
    result.stats.warnings.clear();
    for (std::string line; std::getline(warnings, line);) result.stats.warnings.push_back(line);
}

/// Writes a picture that isn't done.
void write_unfinished(const Picture& picture, const RenderOptions& options) {
    Picture copy = picture;
    copy.metadata["scene"] = options.scene;
    copy.metadata["command"] = options.command_line;
    copy.metadata["complete"] = "no";
    StopToken hurry;
    hurry.request();
    RenderStats stats; // of a filter that nobody waits for
    options.outputs.write(
        std::move(copy), [&](const Picture& p) { return options.denoising.apply(p, hurry, stats); },
        [] { return std::string("{\n  \"complete\": false\n}\n"); });
}

/// From here on time counts that somebody has set: that a scene takes long to read is not the render's affair.
void start_clock(RenderOptions& options, StopToken& stop) {
    if (options.timeout) {
        const double seconds = *options.timeout - options.denoising.reserve_of_time(*options.timeout);
        stop.set_deadline(StopToken::Clock::now() + std::chrono::duration_cast<StopToken::Clock::duration>(
                                                        std::chrono::duration<double>(seconds)));
    }
    if (options.cpu_time)
        stop.set_cpu_limit(cpu_seconds() + *options.cpu_time -
                           options.denoising.reserve_of_cpu_time(*options.cpu_time));
}

RenderResult render_scene(LoadedScene& loaded, RenderOptions& options, std::vector<std::string>& warnings,
                          StopToken& stop) {
    RenderResult result;
    LiveView view(options.writes() ? options.display_server : "", options.outputs.exr,
                  [&](const Picture& picture) { write_unfinished(picture, options); });
    with_threads(options.threads, [&] {
        Scene scene(std::move(loaded.description));
        if (options.skip_bad_paths) loaded.user_paths = usable_paths(scene, std::move(loaded.user_paths), warnings);
        const std::chrono::duration<double> wall = StopToken::Clock::now() - options.begun;
        const StageStats loading{&stages::loading, wall.count(), cpu_seconds(), 0};
        const ImageWindow& window = scene.camera().window();
        options.denoising = {loaded.settings.denoise, !options.outputs.png.empty(),
                             static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height),
                             options.threads};
        start_clock(options, stop);
        const auto progress = options.quiet ? nullptr : progress_on_stderr(stop);
        RunContext context{&stop, progress.get()};
        const std::set<std::string> named = named_settings(options.overrides);
        PassesInTime passes;
        if (options.begins_passes_in_time()) {
            passes = passes_in_time(scene, loaded.settings, named, context, loaded.user_paths);
            loaded.settings = passes.settings;
            options.seconds_of_pass = passes.seconds;
        }
        context.whole_round = options.in_time() && options.checkpoints.asked(); // a picture, if not one to go on from
        const std::uint64_t hash = scene_hash(scene);
        const Picture expected{
            window.width, window.height, {}, render_identity(loaded.settings, hash, loaded.user_paths), {}};
        WorkPartition share = options.checkpoints.share(options.outputs.exr, expected, loaded.settings, options.group);
        if (options.writes()) view.watch(share);
        // Parts of a render have to agree on its settings: none can follow from the time that one has.
        const bool alone = options.group == nullptr && !options.checkpoints.asked();
        result = options.in_time() && alone && loaded.settings.load_map.empty()
                     ? render_in_time(scene, loaded.settings, named, context, loaded.user_paths, share)
                     : render(scene, loaded.settings, context, loaded.user_paths, share);
        if (!result.picture.layers.empty()) add_masks(result.picture, scene, loaded.settings, stop);
        result.stats.begin_with(passes.stats);
        result.stats.stages.insert(result.stats.stages.begin(), loading);
        const auto identity = render_identity(result.settings, hash, loaded.user_paths);
        result.picture.metadata.insert(identity.begin(), identity.end());
        if (options.checkpoints.resume && share.done == nullptr)
            result.stats.remarks.emplace_back("found no checkpoint to go on from: started from the beginning");
    });
    if (options.group != nullptr) join_group(*options.group, result, options.checkpoints.file(options.outputs.exr));
    if (!result.picture.layers.empty()) view.show(result.picture);
    return result;
}

/// The method, where that is to be chosen, and settings of effort that no option names, as the checkpoint has them: a
/// time may have chosen them.
/// @throws InputError where it ends by time, and nobody says when.
Settings with_effort_of(const std::string& checkpoint, Settings settings, const RenderOptions& options,
                        const std::set<std::string>& named) {
    const auto words = words_by_key(read_exr_metadata(checkpoint)["settings"]);
    const bool has_end = settings.passes > 0;
    const auto take = [&](std::string_view key) {
        if (const auto word = words.find(std::string(key)); word != words.end()) apply_override(settings, word->second);
    };
    for (const std::string_view key : kSettingsOfEffort)
        if (!named.contains(std::string(key))) take(key);
    if (!named.contains("brightness_error")) take("brightness_error");
    if (settings.method == &methods::automatic) take("method");
    if (has_end && settings.passes == 0 && settings.target_error == 0 && !options.in_time())
        throw InputError(checkpoint + ": found no number of passes to end with, expected --timeout or --cpu-time as "
                                      "when it was begun");
    return settings;
}

/// @throws InputError where nothing would end the passes.
void require_end(const Settings& settings, const RenderOptions& options) {
    if (settings.passes == 0 && settings.target_error == 0 && !options.in_time())
        throw InputError("found passes=0 and no end, expected --timeout, --cpu-time or --target-error, or a number of "
                         "passes");
}

/// The scene with the settings that the options ask for.
/// @throws InputError for a scene, settings and options that don't go together.
LoadedScene load_for(const RenderOptions& options, std::vector<std::string>& warnings) {
    std::set<std::string> named = named_settings(options.overrides);
    if (options.group != nullptr && options.in_time())
        throw InputError("found --timeout or --cpu-time, which end one process; expected --passes, a number that all "
                         "processes know beforehand");
    with_quality_of({}, options.quality, {}); // a word that is none, before the scene is read
    LoadedScene loaded = load(options.scene, options.overrides, &warnings);
    if (!options.resolution.empty()) set_resolution(loaded.description.window, options.resolution);
    // An error to reach asks for as many passes as that takes, unless somebody says how many.
    if (!options.load_map.empty() && loaded.settings.target_error > 0 && !named.contains("target_error")) {
        warnings.push_back("target_error of the scene has no say with --load-map: the photons of a file are the same "
                           "in every pass");
        loaded.settings.target_error = 0;
    }
    const bool in_passes = options.in_time() && options.checkpoints.asked() && options.load_map.empty();
    const bool to_error =
        loaded.settings.target_error > 0 && (named.contains("target_error") || loaded.settings.passes == 1);
    if ((to_error || in_passes) && !named.contains("passes")) {
        loaded.settings.passes = 0;
        named.insert("passes"); // an effort has no say in it
    }
    const std::vector<std::string> older = options.checkpoints.found(options.outputs.exr);
    const bool goes_on = options.checkpoints.resume && !older.empty();
    const ImageWindow& window = loaded.description.window;
    if (goes_on) loaded.settings = with_effort_of(older.front(), loaded.settings, options, named);
    if (!goes_on && loaded.settings.passes == 0 && loaded.settings.target_error > 0 && options.quality.empty())
        loaded.settings = with_effort_at_most(loaded.settings, effort_of_pass(loaded.settings.target_error),
                                              static_cast<std::int64_t>(window.size()), named);
    loaded.settings = with_quality_of(loaded.settings, options.quality, named);
    require_end(loaded.settings, options);
    for (const auto& [option, file] : {std::pair{"--save-map", &options.save_map}, {"--load-map", &options.load_map}})
        if (!file->empty() && !loaded.settings.method->keeps_photons)
            throw InputError(fmt::format("{}: found method {}, expected one that keeps photons: {}", option,
                                         loaded.settings.method->name, names_of(&Method::keeps_photons)));
    loaded.settings.save_map = options.save_map;
    loaded.settings.load_map = options.load_map;
    if (!options.user_paths.empty()) loaded.user_paths = load_user_paths(options.user_paths);
    return loaded;
}

/// Time for so many passes as they were expected brings the first one to its end.
constexpr double kPassesToBegin = 3;

/// Noise of samples, relative to the picture, from which on hardly a pixel says what its light is.
constexpr double kMostNoise = 1;

void report_noise(RenderResult& result) {
    const Method& method = *result.settings.method;
    if (!method.samples_pixels && !method.keeps_photons) return; // of chains there may be no halves
    const auto noise = sample_noise(result.picture);
    if (!noise) return;
    result.stats.values["noise of samples"] = *noise;
    if (*noise > kMostNoise)
        result.stats.warn(Doubt::samples, fmt::format("pixels are known to {} only (standard error): try more spp or "
                                                      "time, or another method",
                                                      percent(*noise)));
}

/// Filters the picture, and writes what the options ask for.
void write(RenderResult& result, const RenderOptions& options, const StopToken& stop) {
    result.picture.metadata.merge(picture_metadata(options.command_line, options.scene, result.stats));
    const int width = result.picture.width, height = result.picture.height;
    options.outputs.write(
        std::move(result.picture),
        [&](const Picture& picture) { return options.denoising.apply(picture, stop, result.stats); },
        [&] { return json_text(stats_json(result.stats)) + "\n"; });
    if (options.verbose) print_report(result.stats);
    const auto& values = result.stats.values;
    const auto error = values.find("relative error");
    if (!options.quiet)
        tell("{}: {} x {} pixels{}{}\n", options.outputs.exr, width, height,
             result.settings.target_error > 0 && error != values.end() ? ", relative error " + percent(error->second)
                                                                       : "",
             result.stats.complete || (result.settings.target_error > 0 && !stop.requested()) ? "" : ", stopped early");
}

int run(RenderOptions options) {
    StopToken stop;
    if (!options.writes()) options.quiet = true;
    if (options.outputs.exr.empty()) options.outputs.exr = default_exr(options.scene);
    if (options.no_png)
        options.outputs.png.clear();
    else if (options.outputs.png.empty())
        options.outputs.png = default_png(options.outputs.exr);
    const std::string checkpoint = options.checkpoints.file(options.outputs.exr);
    if (options.writes()) options.outputs.check();
    for (const std::string& file : {checkpoint, options.save_map})
        if (!file.empty()) check_writable(file);
    if (!options.load_map.empty()) check_photon_file(options.load_map);
    std::vector<NamedFile> outputs = options.outputs.files();
    outputs.insert(outputs.end(), {{"--save-map", options.save_map}, {"the checkpoint", checkpoint}});
    check_apart(outputs, {{"--load-map", options.load_map}});
    if (options.writes()) options.checkpoints.keep_others(options.outputs.exr);

    const InterruptHandler interrupts(stop);
    std::vector<std::string> load_warnings;
    LoadedScene loaded = load_for(options, load_warnings);
    check_apart(outputs, files_of_scene());
    // Until all have looked at the checkpoints that were there, and the first has refused to replace any.
    if (options.group != nullptr && options.checkpoints.asked()) options.group->wait_for_all();
    options.outputs.exposure = loaded.settings.exposure.value;
    options.outputs.noise_layers = loaded.settings.noise_layers;
    options.outputs.denoise = loaded.settings.denoise;
    RenderResult result = render_scene(loaded, options, load_warnings, stop);
    if (!options.writes()) return stop.requested() ? kInterrupted : kSuccess;
    result.stats.warnings.insert(result.stats.warnings.begin(), load_warnings.begin(), load_warnings.end());
    if (has_picture(result)) report_noise(result);
    if (!options.quiet) print_warnings(result.stats);
    if (!has_picture(result)) {
        if (!stop.requested() && options.checkpoints.asked())
            throw InputError(fmt::format(
                "the time was up before the first unit of work was whole: nothing was written; expected {}, or shorter "
                "units (-D light_paths=..., mutations=..., brightness_samples=..., importons=...)",
                options.seconds_of_pass
                    ? fmt::format("{:.0f} s at least", std::ceil(kPassesToBegin * *options.seconds_of_pass))
                    : "more time"));
        if (!stop.requested()) throw InputError("the time was up before the first pixel: nothing was written");
        tell("keyhole: stopped before there was a unit of work to keep: nothing was written\n");
        return kInterrupted;
    }
    write(result, options, stop);
    if (result.stats.unsaved) throw InputError(*result.stats.unsaved);
    if (stop.requested()) return kInterrupted;
    return options.strict && !result.stats.warnings.empty() ? kNotTrusted : kSuccess;
}

/// The words that a setting may be, in brackets; empty: it is no choice.
template <class T> std::string choices_of(const T& /*setting*/) {
    if constexpr (Choice<T>)
        return fmt::format(" ({})", fmt::join(words_of(T{}), ", "));
    else
        return {};
}

/// All methods, and all settings with their defaults, for the end of the help text.
std::string settings_help() {
    std::string text = "Methods:\n";
    for (const Method* method : all_methods()) text += fmt::format("  {:<42}{}\n", method->name, method->help);
    text += "\nSettings (-D KEY=VALUE, or under `render:` in the scene file) and their defaults:\n";
    const Settings defaults;
    visit_settings(defaults, [&](const char* key, const auto& value, const auto&... rest) {
        const auto row = std::tie(rest...); // help, and before it what numbers lie between
        std::string range = choices_of(value);
        if constexpr (sizeof...(rest) == 3) range = "; " + bounds_text(std::get<0>(row), std::get<1>(row));
        text += fmt::format("  {:<42}{}{}\n", fmt::format("{}={}", key, printable(value)),
                            std::get<sizeof...(rest) - 1>(row), range);
    });
    return text;
}

} // namespace

void add_render_command(CLI::App& app, Action& action, const std::string& command_line, ProcessGroup* group) {
    CLI::App* command = app.add_subcommand("render", "Render a scene");
    auto o = std::make_shared<RenderOptions>();
    o->command_line = command_line;
    o->group = group;
    command->add_option("SCENE", o->scene, "scene file (YAML, .pbrt, .gltf or .glb)")->required();
    command->add_option("-o,--output", o->outputs.exr,
                        "picture to write (.exr); default: the scene's name, in this folder");
    auto* png = command->add_option("--png", o->outputs.png, "tone-mapped picture; default: beside the EXR");
    command->add_flag("--no-png", o->no_png, "write no tone-mapped picture")->excludes(png);
    command->add_option("--stats", o->outputs.stats, "write statistics to this file (JSON)");
    command->add_option("--resolution", o->resolution, "WIDTHxHEIGHT in pixels");
    command->add_option("--user-paths", o->user_paths,
                        "user paths, instead of the scene's, for " + names_of(&Method::follows_user_paths));
    command->add_flag("--skip-bad-paths", o->skip_bad_paths,
                      "leave out user paths that don't work in the scene, with a warning");
    add_setting_options(*command, o->overrides);
    command->add_option("--save-map", o->save_map, "write the photons of the first pass to this file");
    command->add_option("--load-map", o->load_map, "take photons from this file instead of sampling any");
    o->checkpoints.add_options(*command);
    command->add_option("-t,--threads", o->threads, "threads; 0: one for each core")->check(CLI::Range(0, 4096));
    auto* timeout = command->add_option("--timeout", o->timeout, "the best picture that can be made in SECONDS")
                        ->check(real_range(1e-3, 1e9));
    auto* cpu_time =
        command->add_option("--cpu-time", o->cpu_time, "the same in SECONDS of CPU time, of all threads together")
            ->check(real_range(1e-3, 1e9))
            ->excludes(timeout);
    add_quality_option(*command, o->quality)->excludes(timeout)->excludes(cpu_time);
    command->add_flag("--strict", o->strict, "exit with 3 where there is a warning: the picture can't be trusted");
    command->add_option("--display-server", o->display_server, "HOST:PORT of tev, to which the picture so far is sent");
    auto* quiet = command->add_flag("-q,--quiet", o->quiet, "say nothing but errors");
    command->add_flag("-v,--verbose", o->verbose, "print statistics")->excludes(quiet);
    command->footer(settings_help() + "Whole numbers may be written 100k, 2.5M, 1G, 1e6, 16MiB or 16MB.");
    command->callback([&action, o] { action = [o] { return run(*o); }; });
}

} // namespace keyhole
