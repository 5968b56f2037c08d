#include "session/stage_clock.h"

#include "core/progress.h"
#include "scene/ray_counter.h"

#include <algorithm>

namespace keyhole {

StageClock::StageClock(RenderStats& stats, const Stage& stage)
    : stats_(stats), stage_(stage), start_(std::chrono::steady_clock::now()), cpu_(cpu_seconds()),
      rays_(rays_traced()) {}

StageClock::~StageClock() {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start_;
    auto stage = std::ranges::find(stats_.stages, &stage_, &StageStats::stage);
    if (stage == stats_.stages.end()) stage = stats_.stages.insert(stage, {&stage_, 0, 0, 0});
    stage->wall_seconds += wall.count();
    stage->cpu_seconds += cpu_seconds() - cpu_;
    stage->rays += rays_traced() - rays_;
}

} // namespace keyhole
