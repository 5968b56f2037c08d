// The parts that the time of a render is told by.
#pragma once

#include "core/settings.h"

#include <limits>

namespace keyhole {

/// A kind of stage. Its time in all passes is about proportional to what a setting says, and to a power of the number
/// of pixels, from one render of a scene to another by the same method.
struct Stage {
    /// What takes the time.
    enum class Work { other, brightness, chains, gather };

    const char* name;
    std::int64_t Settings::*setting = nullptr; ///< null: the settings have no say
    double pixel_power = 0;
    Work work = Work::other;
    /// Bounds of the setting, beyond which the time follows it no more.
    std::int64_t least = 1, most = std::numeric_limits<std::int64_t>::max();
    bool once = false; ///< for all passes
};

/// Those that several methods have.
namespace stages {
inline constexpr Stage brightness{"brightness", &Settings::brightness_samples, 0, Stage::Work::brightness};
inline constexpr Stage seeds{"seeds"};
inline constexpr Stage importance{"importance", &Settings::importons};
inline constexpr Stage tuning{"tuning"};
inline constexpr Stage chains{"chains", &Settings::mutations, 0, Stage::Work::chains};
inline constexpr Stage photons_of_chains{"photons", &Settings::mutations, 0, Stage::Work::chains};
inline constexpr Stage photons_of_light_paths{"photons", &Settings::light_paths};
/// Of precomputed irradiance: it is estimated at a part of the photons.
inline constexpr Stage irradiance{"irradiance", &Settings::photons, 0, Stage::Work::gather};
// Larger pictures have more cached irradiances, for these may lie as close as a few pixels; most of them don't.
inline constexpr Stage cache{"cache", &Settings::cache_rays, 0.25, Stage::Work::gather};
inline constexpr Stage gather{"gather", &Settings::spp, 1, Stage::Work::gather};
inline constexpr Stage direct_light{"direct light", &Settings::spp, 1};
inline constexpr Stage loading{"loading"};
inline constexpr Stage trials{"trials"};
inline constexpr Stage others{"other renders"};
inline constexpr Stage between{"between stages"};
} // namespace stages

} // namespace keyhole
