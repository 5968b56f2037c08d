// What a render cost, and what others would.
#pragma once

#include "core/render_stats.h"
#include "core/settings.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace keyhole {

/// Work of a stage over all passes, in units of its own: its time is roughly proportional to this, from one render of a
/// scene to another by the same method. @param pixels of the picture.
double stage_work(const Stage& stage, const Settings& settings, double pixels);

/// The cost of a render by stages, from which that of others by the same method is predicted.
struct Experience {
    Settings settings; ///< with the method that was run
    double effort, pixels;
    std::vector<std::pair<const Stage*, double>> stages; ///< seconds or rays of each
    /// Power of the number of pixels by which records of the irradiance cache grow. Predictions go by that of most
    /// scenes: of records that are many, those that don't pay are left out.
    double cache_power = keyhole::stages::cache.pixel_power;

    /// @param seconds that the render took, of the kind that is limited: by the clock, or of CPU time.
    Experience(const Settings& settings, double effort, double pixels, const RenderStats& stats, double seconds);
    /// The same in rays where others have seconds: they are the same on every machine and at every load.
    static Experience in_rays(const Settings& settings, double effort, double pixels, const RenderStats& stats);

    /// What a render with other settings would take [s], or those of its stages that do some `work`, or a single stage
    /// that took `time` here.
    double predict(const Settings& other, double its_pixels) const;
    double predict(Stage::Work work, const Settings& other, double its_pixels) const;
    double predict(const Stage& stage, double time, const Settings& other, double its_pixels) const;
    /// All stages together.
    double total() const;

  private:
    Experience(const Settings& settings, double effort, double pixels, const RenderStats& stats)
        : settings(settings), effort(effort), pixels(pixels) {
        if (stats.photon_quality.cache) cache_power = std::max(cache_power, stats.photon_quality.cache->growth);
    }
};

} // namespace keyhole
