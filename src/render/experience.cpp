#include "render/experience.h"

#include "render/stage_work.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keyhole {

Experience::Experience(const Settings& settings, double effort, double pixels, const RenderStats& stats, double seconds)
    : Experience(settings, effort, pixels) {
    double wall = 0, cpu = 0;
    for (const StageStats& stage : stats.stages) {
        wall += stage.wall_seconds;
        cpu += stage.cpu_seconds;
    }
    const bool by_cpu = std::abs(seconds - cpu) < std::abs(seconds - wall);
    stages.emplace_back("between stages", std::max(0.0, seconds - (by_cpu ? cpu : wall)));
    for (const StageStats& stage : stats.stages)
        stages.emplace_back(stage.name, by_cpu ? stage.cpu_seconds : stage.wall_seconds);
}

Experience Experience::in_rays(const Settings& settings, double effort, double pixels, const RenderStats& stats) {
    Experience e(settings, effort, pixels);
    for (const StageStats& stage : stats.stages) e.stages.emplace_back(stage.name, static_cast<double>(stage.rays));
    return e;
}

double Experience::total() const {
    return std::accumulate(stages.begin(), stages.end(), 0.0,
                           [](double sum, const auto& stage) { return sum + stage.second; });
}

double Experience::foresee(const Settings& other, double its_pixels,
                           std::initializer_list<std::string_view> names) const {
    double sum = 0;
    for (const auto& [name, time] : stages)
        if (names.size() == 0 || std::ranges::find(names, name) != names.end())
            sum += time * stage_work(name, other, its_pixels) / stage_work(name, settings, pixels);
    return sum;
}

} // namespace keyhole
