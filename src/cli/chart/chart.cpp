#include "cli/chart/chart.h"

#include "cli/chart/outputs.h"
#include "cli/program.h"
#include "cli/words/metadata.h"
#include "cli/words/tell.h"
#include "cli/words/units.h"
#include "core/bytes.h"
#include "core/error.h"
#include "core/parallel.h"
#include "sampling/scene_hash.h"
#include "scene/load/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <set>
#include <string_view>

namespace keyhole {
namespace {

namespace fs = std::filesystem;

/// Of all that changes its pictures.
std::uint64_t hash_of(LoadedScene loaded) {
    const std::uint64_t scene = scene_hash(Scene(std::move(loaded.description)));
    Hash hash;
    for (const auto& [key, value] : render_identity(loaded.settings, scene, loaded.user_paths))
        hash.add(std::string_view(key)), hash.add(std::string_view(value));
    return hash.value();
}

std::vector<ChartScene> load_scenes(const ChartOptions& options) {
    std::vector<ChartScene> scenes;
    std::set<std::string> names;
    for (const std::string& path : options.scenes) {
        const std::string name = fs::path(path).stem().string();
        if (!names.insert(name).second) throw InputError(path + ": found a second scene of this name, expected one");
        LoadedScene loaded = load(path, options.settings);
        if (!options.resolution.empty()) set_resolution(loaded.description.window, options.resolution);
        const ImageWindow window = loaded.description.window;
        scenes.push_back({name, path, hash_of(std::move(loaded)), window.width, window.height});
    }
    return scenes;
}

/// What tells the picture of a run from all others.
std::string key_of(const Run& run, const ChartScene& scene) { return scene.key() + " " + run.name(scene); }

class Chart {
  public:
    Chart(const ChartOptions& options, const StopToken& stop)
        : options_(options), stop_(stop), renderer_(options, stop), scenes_(load_scenes(options)),
          log_(options.folder + "/runs.jsonl"), runs_(all_runs(options)), results_(runs_.size()),
          jobs_(options.jobs > 0 ? options.jobs : busy_cores()) {
        fs::create_directories(fs::path(options.folder) / "pictures");
        for (const Run& run : runs_) pictures_.push_back(picture_of(run));
    }

    int make() {
        std::vector<Reference> references;
        for (const ChartScene& scene : scenes_) {
            tell("{}: reference\n", scene.name);
            references.push_back(make_reference(scene, options_, renderer_, jobs_));
            if (stop_.requested()) return kInterrupted;
            if (!references.back().method.empty())
                tell("{}: reference by {}, known to {:.2g} %, {} of CPU time\n", scene.name, references.back().method,
                     100 * references.back().standard_error, duration(references.back().cpu_seconds));
        }
        render_all();
        std::vector<SceneChart> charts;
        for (std::size_t i = 0; i < scenes_.size(); ++i)
            charts.push_back(analyse(scenes_[i], i, std::move(references[i]), runs_, results_, pictures_));
        write(charts);
        return stop_.requested() ? kInterrupted : kSuccess;
    }

  private:
    std::string picture_of(const Run& run) const {
        const ChartScene& scene = scenes_[run.scene];
        return (fs::path(options_.folder) / "pictures" / (run.name(scene) + ".exr")).string();
    }

    /// Takes from the log what is there and renders the rest.
    void render_all() {
        std::vector<std::size_t> missing;
        double seconds = 0;
        for (std::size_t i = 0; i < runs_.size(); ++i) {
            results_[i] = log_.find(key_of(runs_[i], scenes_[runs_[i].scene]));
            if (results_[i] && (!results_[i]->failure.empty() || fs::exists(pictures_[i]))) continue;
            missing.push_back(i);
            seconds += runs_[i].seconds;
        }
        tell("{} runs, {} of them to be made, in about {}\n", runs_.size(), missing.size(), duration(seconds / jobs_));
        std::atomic<std::size_t> done{0};
        run_jobs(jobs_, missing.size(), [&](std::size_t k) {
            if (stop_.requested()) return;
            const std::size_t i = missing[k];
            render(i);
            if (!stop_.requested())
                tell("[{}/{}] {}: {}\n", ++done, missing.size(), runs_[i].name(scenes_[runs_[i].scene]),
                     results_[i]->failure.empty() ? duration(results_[i]->cpu_seconds) : results_[i]->failure);
        });
    }

    void render(std::size_t i) {
        const Run& run = runs_[i];
        const ChartScene& scene = scenes_[run.scene];
        std::vector<std::string> settings = method_settings(run.method);
        settings.push_back(fmt::format("seed={}", run.repeat + 1));
        if (run.memory > 0) settings.push_back(fmt::format("photon_memory={}", run.memory));
        RunResult result = renderer_.render(scene, run.seconds, settings, pictures_[i]);
        if (stop_.requested()) {
            results_[i].reset();
            return;
        }
        log_.add(key_of(run, scene), result);
        results_[i] = std::move(result);
    }

    void write(const std::vector<SceneChart>& charts) const {
        write_tables(options_.folder, charts, options_);
        const std::string message = draw_figures(options_.folder, charts, options_, stop_);
        if (!message.empty()) tell("keyhole: warning: {}\n", message);
        for (const SceneChart& chart : charts)
            for (const std::string& failure : chart.failures) tell("keyhole: warning: {}\n", failure);
        write_page(options_.folder, charts, options_);
        tell("{}/index.html\n", options_.folder);
    }

    const ChartOptions& options_;
    const StopToken& stop_;
    Renderer renderer_;
    std::vector<ChartScene> scenes_;
    RunLog log_;
    std::vector<Run> runs_;
    std::vector<std::optional<RunResult>> results_;
    std::vector<std::string> pictures_;
    int jobs_;
};

} // namespace

int make_chart(const ChartOptions& options, const StopToken& stop) {
    fs::create_directories(options.folder);
    return Chart(options, stop).make();
}

} // namespace keyhole
