#include "cli/chart/runs.h"

#include "cli/words/report.h"
#include "core/error.h"
#include "methods/method.h"
#include "scene/load/yaml/settings_text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace keyhole {
namespace {

using Json = nlohmann::ordered_json;

/// Whether the memory for photons matters to the method. `auto` would repeat what the method that it stands for shows.
bool compares_memory(const std::string& method) {
    Settings settings;
    apply_override(settings, method_settings(method).front());
    return settings.method->keeps_photons && settings.method != &methods::automatic;
}

Json to_json(const std::string& key, const RunResult& r) {
    Json stages = Json::object();
    for (const auto& [name, seconds] : r.stages) stages[name] = seconds;
    return {{"key", key},
            {"cpu_seconds", r.cpu_seconds},
            {"wall_seconds", r.wall_seconds},
            {"peak_bytes", r.peak_bytes},
            {"photon_bytes", r.photon_bytes},
            {"photons", r.photons},
            {"passes", r.passes},
            {"chosen", r.chosen},
            {"stages", stages},
            {"failure", r.failure}};
}

/// The key as the log has it: what is not UTF-8 is replaced.
std::string written(const std::string& key) { return json_line(Json(key)); }

RunResult from_json(const Json& j) {
    RunResult r{.cpu_seconds = j.at("cpu_seconds"),
                .wall_seconds = j.at("wall_seconds"),
                .peak_bytes = j.at("peak_bytes"),
                .photon_bytes = j.at("photon_bytes"),
                .photons = j.at("photons"),
                .passes = j.at("passes"),
                .chosen = j.at("chosen"),
                .stages = {},
                .failure = j.at("failure")};
    for (const auto& [name, seconds] : j.at("stages").items()) r.stages.emplace_back(name, seconds.get<double>());
    return r;
}

} // namespace

std::string ChartScene::key() const { return fmt::format("{}-{}x{}-{:016x}", name, width, height, hash); }

std::string Run::name(const ChartScene& at) const {
    const std::string limit = memory > 0 ? fmt::format("-{}KiB", memory / 1024) : "";
    std::string name = fmt::format("{}-{}-{:g}s{}-{}", at.name, method, seconds, limit, repeat + 1);
    std::ranges::replace(name, '/', '_');
    return name;
}

std::vector<std::string> method_settings(const std::string& method) {
    std::vector<std::string> settings;
    std::istringstream stream("method=" + method);
    for (std::string setting; std::getline(stream, setting, ':');) settings.push_back(setting);
    return settings;
}

std::vector<Run> all_runs(const ChartOptions& options) {
    std::vector<Run> runs;
    for (const double seconds : options.times)
        for (std::size_t scene = 0; scene < options.scenes.size(); ++scene)
            for (const std::string& method : options.methods)
                for (int repeat = 0; repeat < options.repeats; ++repeat)
                    runs.push_back({scene, method, seconds, 0, repeat});
    for (std::size_t scene = 0; scene < options.scenes.size(); ++scene)
        for (const std::string& method : options.methods)
            for (const std::int64_t memory : options.memories)
                for (int repeat = 0; repeat < options.repeats && compares_memory(method); ++repeat)
                    runs.push_back({scene, method, options.longest_time(), memory, repeat});
    return runs;
}

RunLog::RunLog(const std::string& path) {
    std::ifstream before(path);
    std::string whole;
    for (std::string line; std::getline(before, line) && !before.eof();) {
        const Json json = Json::parse(line, nullptr, false);
        if (json.is_discarded() || !json.contains("key"))
            throw InputError(path + ": found a line that is no result of a run, expected a chart's log");
        results_[written(json.at("key"))] = from_json(json);
        whole += line + "\n";
    }
    before.close();
    file_.open(path, std::ios::trunc);
    file_ << whole << std::flush;
    if (!file_) throw InputError(path + ": cannot write");
}

std::optional<RunResult> RunLog::find(const std::string& key) const {
    const std::lock_guard lock(mutex_);
    const auto found = results_.find(written(key));
    return found == results_.end() ? std::nullopt : std::optional(found->second);
}

void RunLog::add(const std::string& key, const RunResult& result) {
    const std::lock_guard lock(mutex_);
    results_[written(key)] = result;
    file_ << json_line(to_json(key, result)) << "\n" << std::flush;
    if (!file_) throw InputError("cannot write to the chart's log: is the disk full?");
}

} // namespace keyhole
