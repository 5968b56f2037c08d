// keyhole chart: speed against accuracy, and memory against accuracy.
#include "cli/chart/chart.h"
#include "cli/chart/runs.h"
#include "cli/program.h"
#include "cli/progress/interrupt.h"
#include "core/error.h"
#include "scene/load/yaml/settings_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace keyhole {
namespace {

struct ChartCommand {
    ChartOptions options;
    std::string methods = "auto,mps,ipm,pm,mlt,pssmlt,mmlt,bdpt,path", times = "1,2,4,8,16", memories;
};

std::vector<std::string> words(const std::string& list) {
    std::vector<std::string> found;
    std::istringstream stream(list);
    for (std::string word; std::getline(stream, word, ',');)
        if (!word.empty()) found.push_back(word);
    return found;
}

std::vector<double> times_from(const std::string& list) {
    std::vector<double> times;
    for (const std::string& word : words(list)) {
        std::size_t end = 0;
        double time = 0;
        try {
            time = std::stod(word, &end);
        } catch (const std::exception&) {
            end = 0;
        }
        if (end != word.size() || !(time > 0 && time < 1e7))
            throw InputError("found --times '" + list + "', expected CPU seconds such as 1,2,4");
        times.push_back(time);
    }
    std::ranges::sort(times);
    if (times.empty()) throw InputError("found no --times, expected CPU seconds such as 1,2,4");
    return times;
}

std::vector<std::int64_t> memories_from(const std::string& list) {
    std::vector<std::int64_t> memories;
    for (const std::string& word : words(list)) {
        Settings settings;
        apply_override(settings, "photon_memory=" + word);
        memories.push_back(settings.photon_memory);
    }
    return memories;
}

/// @throws InputError for settings that the renders would refuse.
void check_methods(const std::vector<std::string>& methods) {
    if (methods.empty()) throw InputError("found no --methods, expected some such as ipm,path");
    for (const std::string& method : methods) {
        Settings settings;
        for (const std::string& setting : method_settings(method)) apply_override(settings, setting);
    }
}

int run(ChartCommand command) {
    ChartOptions& o = command.options;
    o.times = times_from(command.times);
    o.methods = words(command.methods);
    check_methods(o.methods);
    o.memories = memories_from(command.memories);
    if (!o.references.empty() && o.scenes.size() > 1)
        throw InputError("found --reference with more than one scene, expected one");
    StopToken stop;
    const InterruptHandler interrupts(stop);
    return make_chart(o, stop);
}

} // namespace

void add_chart_command(CLI::App& app, Action& action) {
    CLI::App* command = app.add_subcommand("chart", "Chart methods against time and memory");
    auto c = std::make_shared<ChartCommand>();
    ChartOptions& o = c->options;
    command->add_option("SCENES", o.scenes, "scene files")->required();
    command->add_option("-o,--output", o.folder, "folder; one that has part of the chart gets the rest")
        ->capture_default_str();
    command->add_option("--methods", c->methods, "values of the setting method, with others as in mps:power=literal")
        ->capture_default_str();
    command->add_option("--times", c->times, "CPU seconds of a run")->capture_default_str();
    command->add_option("--memory", c->memories, "bytes for photons, tried at the longest time, such as 1M,4M,16M");
    command->add_option("--repeats", o.repeats, "runs of each kind, of different seeds")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    command->add_option("--reference", o.references, "reference (EXR), and a second, independent one; else rendered")
        ->expected(1, 2);
    command->add_option("--reference-error", o.reference_error, "relative standard error to render references to")
        ->capture_default_str()
        ->check(real_range(1e-6, 10.0));
    command->add_option("--reference-time", o.reference_time, "most CPU seconds for the references of a scene")
        ->capture_default_str()
        ->check(real_range(0.1, 1e9));
    command->add_option("--resolution", o.resolution, "WIDTHxHEIGHT in pixels");
    command->add_option("-D", o.settings, "any setting of render, KEY=VALUE; may be repeated")->allow_extra_args(false);
    command->add_option("-j,--jobs", o.jobs, "runs at a time, one thread each; 0: one for each core")
        ->check(CLI::Range(0, 1024));
    command->callback([&action, c] { action = [c] { return run(*c); }; });
}

} // namespace keyhole
