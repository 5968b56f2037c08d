#include "render/expected_cost.h"

#include "render/stage_work.h"

#include <algorithm>
#include <array>

namespace keyhole {
namespace {

constexpr std::int64_t kPart = 16;

/// What the time of the stages is proportional to.
constexpr std::array kDrivers{&Settings::spp,       &Settings::importons,   &Settings::brightness_samples,
                              &Settings::mutations, &Settings::light_paths, &Settings::cache_rays};

Settings part_of(const Settings& settings) {
    Settings part = settings;
    for (const auto driver : kDrivers) part.*driver = std::max<std::int64_t>(1, settings.*driver / kPart);
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
    Settings of_part = part, of_whole = settings;
    of_part.method = of_whole.method = stats.method;
    for (const StageStats& stage : stats.stages)
        cost.stages.emplace_back(stage.name, stage.cpu_seconds * stage_work(stage.name, of_whole, 1) /
                                                 stage_work(stage.name, of_part, 1));
    if (stats.photon_bytes > 0)
        cost.photon_bytes = std::max(stats.photon_bytes, static_cast<std::uint64_t>(settings.photon_memory));
    return cost;
}

} // namespace keyhole
