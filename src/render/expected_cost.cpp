#include "render/expected_cost.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace keyhole {
namespace {

constexpr std::int64_t kPart = 16;

/// The setting that a stage's time is proportional to.
struct Driver {
    std::string_view stage;
    std::int64_t Settings::*setting;
};
constexpr std::array kDrivers{Driver{"gather", &Settings::spp},
                              Driver{"path tracing", &Settings::spp},
                              Driver{"bidirectional path tracing", &Settings::spp},
                              Driver{"direct light", &Settings::spp},
                              Driver{"importance", &Settings::importons},
                              Driver{"brightness", &Settings::brightness_samples},
                              Driver{"chains", &Settings::mutations},
                              Driver{"photons", &Settings::light_paths}};

Settings part_of(const Settings& settings) {
    Settings part = settings;
    for (const Driver& d : kDrivers) part.*d.setting = std::max<std::int64_t>(1, settings.*d.setting / kPart);
    part.brightness_samples = std::max<std::int64_t>(part.brightness_samples, 1000);
    part.importons = std::max<std::int64_t>(part.importons, 1000);
    part.passes = 1;
    return part;
}

} // namespace

double ExpectedCost::cpu_seconds() const {
    double sum = 0;
    for (const auto& stage : stages) sum += stage.second;
    return sum;
}

ExpectedCost expect_cost(Scene& scene, const Settings& settings, const RunContext& context,
                         const UserPathFile& user_paths) {
    const Settings part = part_of(settings);
    const RenderStats stats = render(scene, part, context, user_paths).stats;
    ExpectedCost cost{.method = stats.method, .stages = {}, .photon_bytes = 0, .remarks = stats.remarks};
    const double passes = static_cast<double>(std::max<std::int64_t>(1, settings.passes));
    for (const StageStats& stage : stats.stages) {
        const auto* const driver = std::ranges::find(kDrivers, stage.name, &Driver::stage);
        double factor = 1;
        if (driver != kDrivers.end()) {
            const auto setting = stage.name == "photons" && (stats.method == "mps" || stats.method == "pss")
                                     ? &Settings::mutations
                                     : driver->setting;
            factor = passes * static_cast<double>(settings.*setting) / static_cast<double>(part.*setting);
        }
        cost.stages.emplace_back(stage.name, factor * stage.cpu_seconds);
    }
    if (stats.photon_bytes > 0)
        cost.photon_bytes = std::max(stats.photon_bytes, static_cast<std::uint64_t>(settings.photon_memory));
    return cost;
}

} // namespace keyhole
