// A chart of methods against time and memory.
#pragma once

#include "core/progress.h"

#include <cstdint>
#include <string>
#include <vector>

namespace keyhole {

struct ChartOptions {
    std::vector<std::string> scenes;    ///< files
    std::vector<std::string> methods;   ///< METHOD or METHOD:KEY=VALUE:..., as method_settings() reads
    std::vector<double> times;          ///< CPU seconds of a run, ascending
    std::vector<std::int64_t> memories; ///< bytes for photons, each tried at the longest time
    int repeats = 5;
    std::vector<std::string> references; ///< up to two pictures, for one scene; none: rendered
    double reference_error = 0.02;       ///< relative standard error of a reference to reach
    double reference_time = 240;         ///< most CPU seconds for the references of a scene
    std::string resolution;              ///< empty: the scene's
    std::vector<std::string> settings;   ///< KEY=VALUE, for all runs
    std::string folder = "report";
    int jobs = 0; ///< runs at a time; 0: one for each core

    double longest_time() const { return times.back(); }
};

/// A scene of a chart.
struct ChartScene {
    std::string name; ///< file name without its extension
    std::string path;
    std::uint64_t hash;
    int width, height;

    /// Tells apart what pictures of different scenes and sizes are compared with.
    std::string key() const;
};

/// Makes what is missing of a chart and writes all that its folder holds. Returns an exit code. What a run gave is kept
/// at once, so that the next call goes on where this one was stopped.
/// @throws InputError for scenes, settings or pictures that can't be used.
int make_chart(const ChartOptions& options, const StopToken& stop);

} // namespace keyhole
