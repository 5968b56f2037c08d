// What a render cost, and what others would.
#pragma once

#include "core/render_stats.h"
#include "core/settings.h"

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace keyhole {

/// The cost of a render by stages, from which that of others by the same method is foreseen.
struct Experience {
    Settings settings; ///< with the method that was run
    double effort, pixels;
    std::vector<std::pair<std::string, double>> stages; ///< name, seconds or rays

    /// @param seconds that the render took, of the kind that is limited: by the clock, or of CPU time.
    Experience(const Settings& settings, double effort, double pixels, const RenderStats& stats, double seconds);
    /// The same in rays where others have seconds: they are the same on every machine and at every load.
    static Experience in_rays(const Settings& settings, double effort, double pixels, const RenderStats& stats);

    /// What some stages, all if none is named, of a render with other settings would take [s].
    double foresee(const Settings& other, double its_pixels, std::initializer_list<std::string_view> names = {}) const;
    /// All stages together.
    double total() const;

  private:
    Experience(const Settings& settings, double effort, double pixels)
        : settings(settings), effort(effort), pixels(pixels) {}
};

} // namespace keyhole
