// What the pictures of a chart are held against.
#pragma once

#include "cli/chart/chart.h"
#include "cli/chart/runs.h"
#include "core/progress.h"
#include "film/picture.h"

#include <functional>
#include <optional>
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

struct Reference {
    Image first;
    std::optional<Image> second; ///< independent of the first; their mean is the reference
    std::string method;          ///< that made them; empty: they were given
    double standard_error = 0;   ///< root of the relative squared error of their mean; 0: unknown
    double cpu_seconds = 0;      ///< that they took
};

/// The pictures that the options name, or two that are rendered: by whichever of path, bdpt and mlt is surest here,
/// longer and longer until the standard error or the time that the options name is reached. Parts stay in
/// FOLDER/references, under a name with the scene's hash, and are used again.
/// @throws InputError for pictures of another size.
Reference make_reference(const ChartScene& scene, const ChartOptions& options, const Renderer& renderer, int jobs);

} // namespace keyhole
