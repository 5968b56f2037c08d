#include "render/stage_clock.h"

#include "scene/ray_counter.h"

#include <algorithm>
#include <ctime>

namespace keyhole {
namespace {

/// CPU time of all threads of the process [s].
double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

} // namespace

StageClock::StageClock(RenderStats& stats, std::string name)
    : stats_(stats), name_(std::move(name)), start_(std::chrono::steady_clock::now()), cpu_(cpu_seconds()),
      rays_(rays_traced()) {}

StageClock::~StageClock() {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start_;
    auto stage = std::ranges::find(stats_.stages, name_, &StageStats::name);
    if (stage == stats_.stages.end()) stage = stats_.stages.insert(stage, {name_, 0, 0, 0});
    stage->wall_seconds += wall.count();
    stage->cpu_seconds += cpu_seconds() - cpu_;
    stage->rays += rays_traced() - rays_;
}

} // namespace keyhole
