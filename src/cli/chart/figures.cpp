// The figures of a chart, drawn by gnuplot.
#include "cli/chart/outputs.h"
#include "cli/chart/process.h"
#include "film/files/atomic_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <system_error>

namespace keyhole {
namespace {

namespace fs = std::filesystem;

/// Colours that stay apart for people who see few (Okabe and Ito 2008), then some more.
constexpr std::array<const char*, 10> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                               "#56b4e9", "#7f3fbf", "#8c6d31", "#555555", "#b8b800"};

struct Curve {
    std::string label;
    const char* colour;
    std::string data; ///< lines of: x, error, lowest, highest
};

std::string data_line(double x, const Point& p) {
    // A logarithmic axis has no 0.
    constexpr double kLeast = 1e-6;
    return fmt::format("{:.6g} {:.6g} {:.6g} {:.6g}\n", x, std::max(p.error(), kLeast), std::max(p.low(), kLeast),
                       std::max(p.high(), kLeast));
}

std::vector<Curve> curves_over_time(const SceneChart& chart, const ChartOptions& options) {
    std::vector<Curve> curves;
    for (std::size_t m = 0; m < options.methods.size(); ++m) {
        Curve c{options.methods[m], kColours[m % kColours.size()], ""};
        for (const Point* p : chart.over_time(c.label)) c.data += data_line(p->cpu_seconds, *p);
        if (!c.data.empty()) curves.push_back(std::move(c));
    }
    return curves;
}

std::vector<Curve> curves_over_memory(const SceneChart& chart, const ChartOptions& options) {
    std::vector<Curve> curves;
    for (std::size_t m = 0; m < options.methods.size(); ++m) {
        Curve c{options.methods[m], kColours[m % kColours.size()], ""};
        for (const Point* p : chart.over_memory(c.label))
            c.data += data_line(static_cast<double>(p->photon_bytes) / (1 << 20), *p);
        if (!c.data.empty()) curves.push_back(std::move(c));
    }
    return curves;
}

constexpr const char* kStyle = "set logscale xy\nset grid lc rgb '#dddddd' lw 0.5\nset border 3 lc rgb '#777777'\n"
                               "set tics nomirror\nset key outside right top Left reverse samplen 1.5\n"
                               "set style fill transparent solid 0.15 noborder\nset format y '%g'\n";

/// Commands that draw a figure into NAME.svg and NAME.png.
std::string script(const std::string& name, const std::string& preamble, const std::string& plot) {
    std::string text = kStyle + preamble;
    for (const auto& [terminal, ending] : {std::pair("svg size 720,440 font 'sans,13' background 'white'", "svg"),
                                           {"pngcairo size 1080,660 font 'sans,18' background 'white'", "png"}})
        text += fmt::format("set terminal {}\nset output '{}.{}'\n{}", terminal, name, ending, plot);
    return text;
}

std::string curve_script(const std::string& name, const std::string& axis, const std::vector<Curve>& curves) {
    std::string preamble = fmt::format("set xlabel '{}'\nset ylabel 'relative error'\n", axis), plot = "plot ";
    for (std::size_t i = 0; i < curves.size(); ++i) {
        preamble += fmt::format("$D{} << EOD\n{}EOD\n", i, curves[i].data);
        plot += fmt::format("{}$D{} using 1:3:4 with filledcurves lc rgb '{}' notitle, "
                            "$D{} using 1:2 with linespoints pt 7 ps 0.5 lw 2 lc rgb '{}' title '{}'",
                            i > 0 ? ", " : "", i, curves[i].colour, i, curves[i].colour, curves[i].label);
    }
    return script(name, preamble, plot + "\n");
}

/// Bias and deviation of each method at the longest time, side by side.
std::string parts_script(const std::string& name, const SceneChart& chart, const ChartOptions& options) {
    std::string data;
    for (const std::string& method : options.methods) {
        const auto points = chart.over_time(method);
        if (points.empty() || points.back()->repeats < 2) continue;
        const RepeatError& e = points.back()->squared;
        data += fmt::format("{} {:.6g} {:.6g}\n", method, std::sqrt(std::max(0.0, e.bias)), std::sqrt(e.variance));
    }
    if (data.empty()) return "";
    const std::string preamble =
        fmt::format("unset logscale x\nset style data histograms\nset style histogram clustered gap 1\n"
                    "set style fill solid 0.9 noborder\nset ylabel 'relative error after {:g} s'\n$D << EOD\n{}EOD\n",
                    options.longest_time(), data);
    return script(name, preamble,
                  "plot $D using 2:xtic(1) title 'bias' lc rgb '#d55e00', "
                  "$D using 3 title 'standard deviation' lc rgb '#0072b2'\n");
}

} // namespace

std::string draw_figures(const std::string& folder, const std::vector<SceneChart>& charts, const ChartOptions& options,
                         const StopToken& stop) {
    const fs::path figures = fs::path(folder) / "figures";
    fs::create_directories(figures);
    const auto draw = [&](const std::string& name, const std::string& commands) -> std::string {
        const std::string file = (figures / (name + ".gp")).string();
        write_file_atomically(file, commands);
        const ProcessResult result = run_process("gnuplot", {file}, (figures / "gnuplot.log").string(), stop);
        return result.exit_code == 0 ? "" : "gnuplot failed: " + result.message;
    };
    std::string message;
    try {
        for (const SceneChart& chart : charts) {
            const std::string name = chart.scene.name, path = (figures / name).string();
            const auto add = [&](const std::string& kind, const std::string& commands) {
                if (!commands.empty() && message.empty()) message = draw(name + kind, commands);
            };
            add("-time", curve_script(path + "-time", "CPU time [s]", curves_over_time(chart, options)));
            const auto memory = curves_over_memory(chart, options);
            if (!memory.empty())
                add("-memory", curve_script(path + "-memory", "memory of photons and what serves them [MiB]", memory));
            add("-parts", parts_script(path + "-parts", chart, options));
        }
    } catch (const std::system_error&) {
        return "no figures: gnuplot is not installed (on Debian: apt-get install gnuplot-nox)";
    }
    fs::remove(figures / "gnuplot.log");
    return message;
}

} // namespace keyhole
