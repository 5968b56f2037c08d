#include "render/stage_work.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace keyhole {
namespace {

struct Driver {
    std::string_view stage;
    std::int64_t Settings::*setting;
    double pixel_power; ///< of the number of pixels in a stage's time
};
// Larger pictures have more cached irradiances, for these may lie as close as a few pixels; most of them don't.
constexpr std::array kDrivers{Driver{"gather", &Settings::spp, 1},
                              Driver{"path tracing", &Settings::spp, 1},
                              Driver{"bidirectional path tracing", &Settings::spp, 1},
                              Driver{"direct light", &Settings::spp, 1},
                              Driver{"cache", &Settings::cache_rays, 0.25},
                              Driver{"importance", &Settings::importons, 0},
                              Driver{"brightness", &Settings::brightness_samples, 0},
                              Driver{"chains", &Settings::mutations, 0},
                              Driver{"photons", &Settings::light_paths, 0}};

bool runs_chains(const std::string& method) { return method == "mps" || method == "pss"; }

} // namespace

double stage_work(std::string_view stage, const Settings& settings, double pixels) {
    const auto* const driver = std::ranges::find(kDrivers, stage, &Driver::stage);
    if (driver == kDrivers.end()) return 1;
    const auto setting = stage == "photons" && runs_chains(settings.method) ? &Settings::mutations : driver->setting;
    return static_cast<double>(std::max<std::int64_t>(1, settings.passes)) * static_cast<double>(settings.*setting) *
           std::pow(pixels, driver->pixel_power);
}

} // namespace keyhole
