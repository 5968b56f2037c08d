// The runs of a chart, and the file that keeps what they gave.
#pragma once

#include "cli/chart/chart.h"

#include <cstdint>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace keyhole {

/// One render.
struct Run {
    std::size_t scene;       ///< index
    std::string method;      ///< with its settings
    double seconds;          ///< CPU time that it may use
    std::int64_t memory = 0; ///< for photons; 0: the setting's default
    int repeat = 0;          ///< its seed is one more

    /// File name of its picture, without extension.
    std::string name(const ChartScene& at) const;
};

/// What a run gave.
struct RunResult {
    double cpu_seconds = 0, wall_seconds = 0; ///< of the process
    std::int64_t peak_bytes = 0,
                 photon_bytes = 0; ///< resident memory of the process; photons with all that serves them
    std::int64_t photons = 0, passes = 0;
    std::string chosen;                                 ///< method that `auto` stood for, or the method
    std::vector<std::pair<std::string, double>> stages; ///< name, CPU seconds
    std::string failure;                                ///< why there is no picture; empty: there is one
};

/// All runs of a chart: short ones first, so that an early end leaves every method something.
std::vector<Run> all_runs(const ChartOptions& options);

/// Settings that "METHOD:KEY=VALUE:KEY=VALUE" stands for: {"method=METHOD", "KEY=VALUE", ...}.
std::vector<std::string> method_settings(const std::string& method);

/// A file of one JSON object a line, appended to as results come, so that a chart that was interrupted goes on where it
/// stopped. A last line that was cut short is ignored. Thread-safe.
class RunLog {
  public:
    /// @throws InputError if the file can't be written, or is no log.
    explicit RunLog(const std::string& path);

    /// `key` tells runs apart that differ in anything that changes their pictures.
    std::optional<RunResult> find(const std::string& key) const;
    void add(const std::string& key, const RunResult& result);

  private:
    mutable std::mutex mutex_;
    std::map<std::string, RunResult> results_;
    std::ofstream file_;
};

} // namespace keyhole
