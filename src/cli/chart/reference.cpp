#include "cli/chart/reference.h"

#include "cli/chart/process.h"
#include "cli/pictures/beauty.h"
#include "cli/program.h"
#include "cli/words/tell.h"
#include "core/error.h"
#include "film/files/exr.h"
#include "film/image_error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

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

constexpr std::array<const char*, 3> kCandidates{"path", "bdpt", "mlt"}; // unbiased, and drawn directly

/// Two independent pictures, each the mean of the parts made so far.
struct Pair {
    std::string method;
    Image a, b;
    double seconds = 0; ///< CPU time of each
    int parts = 0;

    /// Root of the relative squared error of (a + b) / 2, from how a and b differ.
    double standard_error() const { return std::sqrt(image_error(a, mean_of(a, b)).relmse_trim); }
    double brightness() const { return (mean(Grey(a).y) + mean(Grey(b).y)) / 2; }
    /// How much of the brightness may be chance.
    double brightness_error() const { return std::abs(mean(Grey(a).y) - mean(Grey(b).y)); }
};

void average_in(Image& sum, const Image& part, double share) {
    if (sum.data.empty()) sum = Image(part.width, part.height, part.channels);
    for (std::size_t i = 0; i < sum.data.size(); ++i)
        sum.data[i] += static_cast<float>(share) * (part.data[i] - sum.data[i]);
}

class ReferenceMaker {
  public:
    ReferenceMaker(const ChartScene& scene, const ChartOptions& options, const Renderer& renderer, int jobs)
        : scene_(scene), options_(options), renderer_(renderer), jobs_(jobs),
          folder_(fs::path(options.folder) / "references" / scene.key()) {
        fs::create_directories(folder_);
    }

    Reference make() {
        Pair pair = best_candidate();
        for (double part = trial_seconds(); !renderer_.stopped() && pair.standard_error() > options_.reference_error &&
                                            2 * (pair.seconds + part) <= options_.reference_time;
             part *= 1.5)
            extend(pair, part);
        const double error = pair.standard_error();
        return {std::move(pair.a), std::move(pair.b), pair.method, error, 2 * pair.seconds};
    }

  private:
    double trial_seconds() const { return std::min(options_.longest_time(), options_.reference_time / 12); }

    /// The method of least difference between two of its pictures, among those that miss no light.
    Pair best_candidate() {
        std::array<Pair, kCandidates.size()> pairs;
        double brightest = 0;
        std::vector<std::string> failures;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            pairs[i].method = kCandidates[i];
            try {
                extend(pairs[i], trial_seconds());
            } catch (const InputError& e) { // too little time for it: the others may do
                failures.emplace_back(e.what());
                continue;
            }
            if (renderer_.stopped()) return pairs[0];
            brightest = std::max(brightest, pairs[i].brightness() - 3 * pairs[i].brightness_error());
        }
        const Pair* best = nullptr;
        for (const Pair& pair : pairs) {
            if (pair.parts == 0) continue;
            const bool misses_light = pair.brightness() < 0.97 * brightest;
            if (!misses_light && (best == nullptr || pair.standard_error() < best->standard_error())) best = &pair;
        }
        if (best == nullptr) throw InputError(failures.back());
        for (const std::string& failure : failures) tell("keyhole: warning: {}; others make it\n", failure);
        return *best;
    }

    /// Renders another part of both pictures, or takes it from an earlier chart.
    void extend(Pair& pair, double seconds) {
        std::array<Image, 2> parts;
        run_jobs(std::min(jobs_, 2), 2, [&](std::size_t side) {
            const std::string file =
                (folder_ / fmt::format("{}-{:g}s-{}{}.exr", pair.method, seconds, pair.parts, "ab"[side])).string();
            // Seeds that no run of the chart has.
            const std::size_t seed = 1'000'000 + 2 * static_cast<std::size_t>(pair.parts) + side;
            if (!fs::exists(file)) {
                const RunResult result =
                    renderer_.render(scene_, seconds, {"method=" + pair.method, fmt::format("seed={}", seed)}, file);
                if (!result.failure.empty() && !renderer_.stopped())
                    throw InputError(
                        fmt::format("{}: no reference by {}: {}", scene_.path, pair.method, result.failure));
            }
            if (!renderer_.stopped()) parts[side] = read_beauty(file);
        });
        if (renderer_.stopped()) return;
        pair.seconds += seconds;
        ++pair.parts;
        average_in(pair.a, parts[0], seconds / pair.seconds);
        average_in(pair.b, parts[1], seconds / pair.seconds);
    }

    const ChartScene& scene_;
    const ChartOptions& options_;
    const Renderer& renderer_;
    int jobs_;
    fs::path folder_;
};

Image read_reference(const std::string& path, const ChartScene& scene) {
    Image image = read_beauty(path);
    if (image.width != scene.width || image.height != scene.height)
        throw InputError(fmt::format("{}: found a picture of {} x {} pixels, expected {} x {} as the scene has", path,
                                     image.width, image.height, scene.width, scene.height));
    return image;
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

Reference make_reference(const ChartScene& scene, const ChartOptions& options, const Renderer& renderer, int jobs) {
    if (options.references.empty()) return ReferenceMaker(scene, options, renderer, jobs).make();
    Reference reference;
    reference.first = read_reference(options.references[0], scene);
    if (options.references.size() > 1) reference.second = read_reference(options.references[1], scene);
    return reference;
}

} // namespace keyhole
