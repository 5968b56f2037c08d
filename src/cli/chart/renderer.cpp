#include "cli/chart/renderer.h"

#include "cli/chart/process.h"
#include "cli/command.h"
#include "film/files/exr.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <thread>

namespace keyhole {
namespace {

namespace fs = std::filesystem;

/// Most of a picture is layers that no chart looks at.
void keep_beauty(const std::string& from, const std::string& to) {
    Picture picture = read_exr(from);
    std::erase_if(picture.layers, [](const auto& layer) { return layer.first != "beauty"; });
    write_exr(to, picture);
    fs::remove(from);
}

void read_statistics(const std::string& path, RunResult& result) {
    const auto stats = nlohmann::ordered_json::parse(std::ifstream(path));
    result.chosen = stats.at("method");
    result.photon_bytes = stats.at("photon_bytes");
    result.photons = stats.at("photons_global").get<std::int64_t>() + stats.at("photons_caustic").get<std::int64_t>();
    result.passes = static_cast<std::int64_t>(stats.at("values").value("passes", 1.0));
    for (const auto& stage : stats.at("stages")) result.stages.emplace_back(stage.at("name"), stage.at("cpu_seconds"));
    fs::remove(path);
}

} // namespace

RunResult Renderer::render(const ChartScene& scene, double cpu_seconds, const std::vector<std::string>& settings,
                           const std::string& picture) const {
    const std::string stem = fs::path(picture).replace_extension().string();
    const std::string unfinished = stem + ".unfinished.exr", stats = stem + ".stats.json", log = stem + ".log";
    std::vector<std::string> arguments{"render",       scene.path,
                                       "-o",           unfinished,
                                       "--stats",      stats,
                                       "--no-png",     "-q",
                                       "-t",           "1",
                                       "--cpu-time",   fmt::format("{}", cpu_seconds),
                                       "--resolution", fmt::format("{}x{}", scene.width, scene.height)};
    for (const auto* list : {&options_.settings, &settings})
        for (const std::string& setting : *list) arguments.insert(arguments.end(), {"-D", setting});
    const ProcessResult process = run_process(kSelf, arguments, log, stop_);
    RunResult result{.cpu_seconds = process.cpu_seconds,
                     .wall_seconds = process.wall_seconds,
                     .peak_bytes = process.peak_bytes,
                     .chosen = {},
                     .stages = {},
                     .failure = {}};
    if (process.exit_code == kSuccess) {
        keep_beauty(unfinished, picture);
        read_statistics(stats, result);
    } else {
        result.failure = process.exit_code < 0 ? "ended by a signal" : process.message;
    }
    fs::remove(log);
    return result;
}

void run_jobs(int jobs, std::size_t n, const std::function<void(std::size_t)>& body) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex mutex;
    const auto work = [&] {
        for (std::size_t i = next++; i < n; i = next++) {
            try {
                body(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!failure) failure = std::current_exception();
                next = n;
            }
        }
    };
    {
        std::vector<std::jthread> threads;
        for (int i = 1; i < jobs; ++i) threads.emplace_back(work);
        work();
    }
    if (failure) std::rethrow_exception(failure);
}

} // namespace keyhole
