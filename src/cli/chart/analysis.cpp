#include "cli/chart/analysis.h"

#include "cli/pictures/beauty.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace keyhole {
namespace {

/// Estimates free of the references' noise may fall below 0.
double root(double squared) { return std::sqrt(std::max(0.0, squared)); }

void add_stage(std::vector<std::pair<std::string, double>>& stages, const std::string& name, double seconds) {
    const auto found = std::ranges::find(stages, name, &std::pair<std::string, double>::first);
    if (found == stages.end())
        stages.emplace_back(name, seconds);
    else
        found->second += seconds;
}

/// A point from its repeats, given as indices.
Point make_point(const std::vector<std::size_t>& repeats, const Reference& reference, const std::vector<Run>& runs,
                 const std::vector<std::optional<RunResult>>& results, const std::vector<std::string>& pictures) {
    const Run& run = runs[repeats.front()];
    const RunResult& first = *results[repeats.front()];
    Point p{.method = run.method,
            .seconds = run.seconds,
            .memory = run.memory,
            .repeats = static_cast<int>(repeats.size()),
            .photons = first.photons,
            .passes = first.passes,
            .chosen = first.chosen,
            .stages = {},
            .squared = {},
            .picture = pictures[repeats.front()]};
    std::vector<Image> images;
    for (const std::size_t i : repeats) {
        const RunResult& r = *results[i];
        const double share = 1 / static_cast<double>(repeats.size());
        p.cpu_seconds += share * r.cpu_seconds;
        p.peak_bytes = std::max(p.peak_bytes, r.peak_bytes);
        p.photon_bytes = std::max(p.photon_bytes, r.photon_bytes);
        for (const auto& [name, seconds] : r.stages) add_stage(p.stages, name, share * seconds);
        images.push_back(read_beauty(pictures[i]));
    }
    p.squared = repeat_error(images, reference.first, reference.second ? &*reference.second : nullptr);
    return p;
}

} // namespace

double Point::error() const { return root(squared.error); }
double Point::low() const { return root(std::ranges::min(squared.each)); }
double Point::high() const { return root(std::ranges::max(squared.each)); }

std::vector<const Point*> SceneChart::over_time(const std::string& method) const {
    std::vector<const Point*> found;
    for (const Point& p : points)
        if (p.method == method && p.memory == 0) found.push_back(&p);
    return found;
}

std::vector<const Point*> SceneChart::over_memory(const std::string& method) const {
    std::vector<const Point*> found;
    for (const Point& p : points)
        if (p.method == method && p.memory > 0) found.push_back(&p);
    const auto unlimited = over_time(method);
    if (!found.empty() && !unlimited.empty()) found.push_back(unlimited.back());
    return found;
}

SceneChart analyse(const ChartScene& scene, std::size_t index, Reference reference, const std::vector<Run>& runs,
                   const std::vector<std::optional<RunResult>>& results, const std::vector<std::string>& pictures) {
    SceneChart chart{scene, std::move(reference), {}, {}};
    std::map<std::tuple<bool, std::string, double, std::int64_t>, std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const Run& run = runs[i];
        if (run.scene != index || !results[i]) continue;
        if (results[i]->failure.empty())
            groups[{run.memory > 0, run.method, run.seconds, run.memory}].push_back(i);
        else
            chart.failures.push_back(run.name(scene) + ": " + results[i]->failure);
    }
    for (const auto& [key, repeats] : groups)
        chart.points.push_back(make_point(repeats, chart.reference, runs, results, pictures));
    return chart;
}

std::optional<double> slope(const std::vector<const Point*>& points) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Point* p : points) {
        if (!(p->error() > 0 && p->cpu_seconds > 0)) continue;
        const double u = std::log(p->cpu_seconds), v = std::log(p->error());
        n += 1;
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    const double spread = n * xx - x * x;
    return n >= 2 && spread > 1e-9 ? std::optional((n * xy - x * y) / spread) : std::nullopt;
}

std::optional<double> time_to(const std::vector<const Point*>& points, double error) {
    std::optional<double> time;
    const Point* above = nullptr;
    for (const Point* p : points) {
        if (p->error() > error) {
            time.reset();
            above = p;
        } else if (!time) {
            const bool between = above != nullptr && p->error() > 0;
            const double t = between ? std::log(above->error() / error) / std::log(above->error() / p->error()) : 1;
            time = between ? above->cpu_seconds * std::pow(p->cpu_seconds / above->cpu_seconds, t) : p->cpu_seconds;
        }
    }
    return time;
}

} // namespace keyhole
