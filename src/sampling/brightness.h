// Stage one: the mean luminance B_eye of what stage two samples, and seeds for its chains. Where the path set weighs
// pixels, "luminance" is weighted luminance.
#pragma once

#include "core/parallel.h"
#include "core/progress.h"
#include "core/statistics.h"
#include "sampling/guidance/guided_paths.h"
#include "sampling/paths/independent_paths.h"
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace keyhole {

struct StageOneSettings {
    PathSet set = PathSet::stored;
    int max_scatterings = 24;
    std::int64_t samples = 400'000;
    /// Relative standard error of B_eye for which up to kMostTimes as many samples are taken; 0: no more than
    /// `samples`.
    double error = 0;
    std::uint64_t seed = 1;
    const GuidedPaths* guides = nullptr; ///< to add to every sample; null: there are none. Must outlive stage one
};

/// Result of stage one. Reproducible bit for bit on any number of threads.
struct StageOne {
    Technique technique = Technique::path; ///< that made it, chosen by trial
    RunningStats brightness;               ///< B_eye [W/(m^2 sr)] over the window, one entry a sample
    RunningStats caustic;                  ///< the part of it that the caustic map holds
    std::int64_t samples = 0;              ///< samples taken
    std::int64_t wanted = 0;               ///< that were to be taken
    std::vector<double> groups;            ///< sum of contributions of each kGroup consecutive samples

    static constexpr std::int64_t kGroup = 32;
    static constexpr std::int64_t kMostTimes = 8;

    Range all_groups() const { return {0, static_cast<std::int64_t>(groups.size())}; }
    /// Whether all samples were taken, and no stop cut them short.
    bool is_whole() const { return samples == wanted; }
    /// B_eye from the samples of some groups alone [W/(m^2 sr)]; 0 without samples.
    double brightness_of(Range some) const;
};

/// Independent paths over the window, by whichever technique needs less work for the same error here. A trial that none
/// of the samples has a part in chooses the technique, and how many samples are enough: chosen by the samples
/// themselves their number would pull their mean, since those that miss the brightest paths seem precise.
StageOne run_stage_one(const Scene& scene, const StageOneSettings& settings, const RunContext& context);

/// `count` of the paths that the samples of some groups found, drawn with probability proportional to the luminance of
/// their contributions by systematic resampling, traced again from their random streams. Empty if none found light.
std::vector<Path> choose_seeds(const Scene& scene, const StageOneSettings& settings, const StageOne& stage,
                               Range groups, std::int64_t count);

} // namespace keyhole
