// Renders for a chart: one thread, so much CPU time, in a process of its own.
#pragma once

#include "cli/chart/options.h"
#include "cli/chart/runs.h"
#include "core/progress.h"

#include <functional>
#include <string>
#include <vector>

namespace keyhole {

/// Thread-safe.
class Renderer {
  public:
    Renderer(const ChartOptions& options, const StopToken& stop) : options_(options), stop_(stop) {}

    /// Renders the picture, of which the file keeps "beauty" alone.
    /// @param settings KEY=VALUE, after those of the options.
    /// What went wrong stands in the result's `failure`.
    RunResult render(const ChartScene& scene, double cpu_seconds, const std::vector<std::string>& settings,
                     const std::string& picture) const;

    bool stopped() const { return stop_.requested(); }

  private:
    const ChartOptions& options_;
    const StopToken& stop_;
};

/// Calls body(i) for i in [0, n) in that order, `jobs` at a time. After an exception no more are begun, and the first
/// one is thrown on.
void run_jobs(int jobs, std::size_t n, const std::function<void(std::size_t)>& body);

} // namespace keyhole
