// Stage one: the mean luminance B_eye of what stage two samples, seeds for its chains, and importance.
#pragma once

#include "core/progress.h"
#include "core/statistics.h"
#include "sampling/independent_paths.h"
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace keyhole {

/// Importance that arrived at a surface from the eye; the adjoint of a photon. `weight` is RGB throughput from a window
/// of density 1, so that the mean over samples of a sum over importons is an integral over eye sides.
struct Importon {
    SurfacePoint point;
    Vec3 to_eye; ///< unit
    Rgb weight;
};

struct StageOneSettings {
    PathSet set = PathSet::stored;
    int max_scatterings = 24;
    std::int64_t samples = 400'000;
    std::int64_t importons = 0; ///< about how many to keep of each kind; 0: none
    std::uint64_t seed = 1;
};

/// Result of stage one. Reproducible bit for bit on any number of threads.
struct StageOne {
    Technique technique = Technique::path; ///< that made it, chosen by trial
    RunningStats brightness;           ///< B_eye [W/(m^2 sr)] over the window, one entry a sample
    RunningStats caustic;              ///< the part of it that the caustic map holds
    std::int64_t samples = 0;          ///< samples taken; fewer than asked for after a stop
    std::int64_t importon_samples = 0; ///< samples that importons were kept from
    std::vector<Importon> first, second; ///< at the first and second non-specular vertex seen
    std::vector<double> groups;        ///< sum of contributions of each kGroup consecutive samples

    static constexpr std::int64_t kGroup = 32;
};

/// Independent paths over the window, by whichever technique needs less work for the same error here.
StageOne run_stage_one(const Scene& scene, const StageOneSettings& settings, const RunContext& context);

/// `count` of the traced paths, drawn with probability proportional to the luminance of their contributions by
/// systematic resampling, traced again from their random streams. Empty if no path found light.
std::vector<Path> choose_seeds(const Scene& scene, const StageOneSettings& settings, const StageOne& stage,
                               std::int64_t count);

} // namespace keyhole
