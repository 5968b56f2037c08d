#include "render/sample_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyhole {
namespace {

/// Of the mean over the picture; pixels are worse.
constexpr double kMostError = 0.05;

} // namespace

void report_samples(const RunningStats& luminance, RenderStats& stats) {
    if (!(luminance.mean() > 0)) return;
    const double error = luminance.standard_error() / luminance.mean();
    stats.values["relative error of the mean"] = error;
    if (luminance.count() < 2 || error > kMostError)
        stats.warnings.push_back(fmt::format("samples of pixels are so few or unequal that the mean of the picture is "
                                             "known to {:.0f} % only (standard error): try more spp",
                                             100 * error));
}

void report_eye_paths(const RunningStats& luminance, const Scene& scene, RenderStats& stats) {
    report_samples(luminance, stats);
    if (luminance.count() > 0 && !(luminance.mean() > 0))
        stats.warnings.emplace_back("no sample carried light: the picture is black. If there is light in the scene, it "
                                    "comes where paths from the eye don't find it: try mps");
    const bool no_extent = std::ranges::any_of(scene.emitters(), [](const auto& e) { return e->is_delta(); });
    if (no_extent && scene.traits().delta)
        stats.warnings.emplace_back("light from emitters without extent that comes through specular surfaces is "
                                    "missing, or what is seen of it in others: paths from the eye can't find it. Use "
                                    "mps");
}

} // namespace keyhole
