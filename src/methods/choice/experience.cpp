#include "methods/choice/experience.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keyhole {

double stage_work(const Stage& stage, const Settings& settings, double pixels) {
    if (stage.setting == nullptr) return 1;
    const std::int64_t passes = stage.once ? 1 : std::max<std::int64_t>(1, settings.passes);
    const std::int64_t value = std::clamp(settings.*stage.setting, stage.least, stage.most);
    return static_cast<double>(passes) * static_cast<double>(value) * std::pow(pixels, stage.pixel_power);
}

Experience::Experience(const Settings& settings, double effort, double pixels, const RenderStats& stats, double seconds)
    : Experience(settings, effort, pixels, stats) {
    double wall = 0, cpu = 0;
    for (const StageStats& stage : stats.stages) {
        wall += stage.wall_seconds;
        cpu += stage.cpu_seconds;
    }
    const bool by_cpu = std::abs(seconds - cpu) < std::abs(seconds - wall);
    stages.emplace_back(&keyhole::stages::between, std::max(0.0, seconds - (by_cpu ? cpu : wall)));
    for (const StageStats& stage : stats.stages)
        stages.emplace_back(stage.stage, by_cpu ? stage.cpu_seconds : stage.wall_seconds);
}

Experience Experience::in_rays(const Settings& settings, double effort, double pixels, const RenderStats& stats) {
    Experience e(settings, effort, pixels, stats);
    for (const StageStats& stage : stats.stages) e.stages.emplace_back(stage.stage, static_cast<double>(stage.rays));
    return e;
}

double Experience::total() const {
    return std::accumulate(stages.begin(), stages.end(), 0.0,
                           [](double sum, const auto& stage) { return sum + stage.second; });
}

double Experience::predict(const Settings& other, double its_pixels) const {
    double sum = 0;
    for (const auto& [stage, time] : stages) sum += predict(*stage, time, other, its_pixels);
    return sum;
}

double Experience::predict(Stage::Work work, const Settings& other, double its_pixels) const {
    double sum = 0;
    for (const auto& [stage, time] : stages)
        if (stage->work == work) sum += predict(*stage, time, other, its_pixels);
    return sum;
}

double Experience::predict(const Stage& stage, double time, const Settings& other, double its_pixels) const {
    return time * stage_work(stage, other, its_pixels) / stage_work(stage, settings, pixels);
}

} // namespace keyhole
