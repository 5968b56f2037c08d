// From the runs of a chart to its figures.
#pragma once

#include "cli/chart/reference.h"
#include "cli/chart/runs.h"
#include "film/image_error.h"

#include <optional>

namespace keyhole {

/// Repeats of the same run. Errors are relative; see RepeatError for the measure, of which they are the root.
struct Point {
    std::string method;
    double seconds;      ///< CPU time that was asked for
    std::int64_t memory; ///< for photons that was asked for; 0: none
    int repeats = 0;
    double cpu_seconds = 0;                             ///< used, mean over the repeats
    std::int64_t peak_bytes = 0, photon_bytes = 0;      ///< largest of the repeats
    std::int64_t photons = 0, passes = 0;               ///< of the first repeat
    std::string chosen;                                 ///< method behind `auto`, of the first repeat
    std::vector<std::pair<std::string, double>> stages; ///< CPU seconds, mean over the repeats
    RepeatError squared;
    std::string picture; ///< file of the first repeat

    double error() const;             ///< root of what is to be expected of one picture
    double low() const, high() const; ///< of the repeats
};

/// All that a chart says about a scene.
struct SceneChart {
    ChartScene scene;
    Reference reference;
    std::vector<Point> points;         ///< those over time by method and time, then those over memory
    std::vector<std::string> failures; ///< runs that gave no picture, in words

    /// Points over time of a method, by time.
    std::vector<const Point*> over_time(const std::string& method) const;
    /// Points over memory of a method, by memory; at the longest time without a limit last.
    std::vector<const Point*> over_memory(const std::string& method) const;
};

/// @param results of the runs with that index; none: not there yet. Runs of other scenes are passed over.
/// @param pictures file names, likewise.
SceneChart analyse(const ChartScene& scene, std::size_t index, Reference reference, const std::vector<Run>& runs,
                   const std::vector<std::optional<RunResult>>& results, const std::vector<std::string>& pictures);

/// Slope of log(error) over log(CPU time) by least squares; -1/2 is what independent unbiased samples have. None below
/// two points with an error.
std::optional<double> slope(const std::vector<const Point*>& points);

/// CPU seconds at which the error falls below `error` for good, straight lines in logarithms between points. None if it
/// doesn't; the first point's time if it is below throughout.
std::optional<double> time_to(const std::vector<const Point*>& points, double error);

} // namespace keyhole
