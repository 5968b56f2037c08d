// The figures of a chart as CSV.
#include "cli/chart/outputs.h"
#include "film/files/atomic_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace keyhole {
namespace {

/// Nothing where there is no number.
std::string number_text(double x) { return std::isfinite(x) ? fmt::format("{:.6g}", x) : ""; }
std::string number_text(std::optional<double> x) { return x ? number_text(*x) : ""; }

std::string points_csv(const std::vector<SceneChart>& charts) {
    std::string text = "scene,method,chosen,seconds,memory,repeats,cpu_seconds,error,lowest,highest,squared_error,"
                       "squared_bias,variance,peak_bytes,photon_bytes,photons,passes\n";
    for (const SceneChart& chart : charts)
        for (const Point& p : chart.points)
            text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", chart.scene.name, p.method,
                                p.chosen, p.seconds, p.memory, p.repeats, number_text(p.cpu_seconds),
                                number_text(p.error()), number_text(p.low()), number_text(p.high()),
                                number_text(p.squared.error), number_text(p.squared.bias),
                                number_text(p.squared.variance), p.peak_bytes, p.photon_bytes, p.photons, p.passes);
    return text;
}

std::string runs_csv(const std::vector<SceneChart>& charts) {
    std::string text = "scene,method,seconds,memory,repeat,squared_error\n";
    for (const SceneChart& chart : charts)
        for (const Point& p : chart.points)
            for (std::size_t k = 0; k < p.squared.each.size(); ++k)
                text += fmt::format("{},{},{},{},{},{}\n", chart.scene.name, p.method, p.seconds, p.memory, k + 1,
                                    number_text(p.squared.each[k]));
    return text;
}

std::string stages_csv(const std::vector<SceneChart>& charts) {
    std::string text = "scene,method,seconds,memory,stage,cpu_seconds\n";
    for (const SceneChart& chart : charts)
        for (const Point& p : chart.points)
            for (const auto& [stage, seconds] : p.stages)
                text += fmt::format("{},{},{},{},{},{}\n", chart.scene.name, p.method, p.seconds, p.memory, stage,
                                    number_text(seconds));
    return text;
}

std::string methods_csv(const std::vector<SceneChart>& charts, const ChartOptions& options) {
    constexpr std::array<double, 4> kErrors{0.3, 0.1, 0.05, 0.03};
    std::string text = "scene,method,slope,error_at_longest";
    for (const double e : kErrors) text += fmt::format(",seconds_to_{:g}", e);
    text += "\n";
    for (const SceneChart& chart : charts) {
        for (const std::string& method : options.methods) {
            const auto points = chart.over_time(method);
            if (points.empty()) continue;
            text += fmt::format("{},{},{},{}", chart.scene.name, method, number_text(slope(points)),
                                number_text(points.back()->error()));
            for (const double e : kErrors) text += fmt::format(",{}", number_text(time_to(points, e)));
            text += "\n";
        }
    }
    return text;
}

} // namespace

void write_tables(const std::string& folder, const std::vector<SceneChart>& charts, const ChartOptions& options) {
    write_file_atomically(folder + "/points.csv", points_csv(charts));
    write_file_atomically(folder + "/runs.csv", runs_csv(charts));
    write_file_atomically(folder + "/stages.csv", stages_csv(charts));
    write_file_atomically(folder + "/methods.csv", methods_csv(charts, options));
}

} // namespace keyhole
