#include "cli/pictures/denoising.h"

#include "core/parallel.h"
#include "session/stage_clock.h"

#include <algorithm>
#include <new>
#include <thread>

namespace keyhole {
namespace {

constexpr Stage kDenoising{"denoising"};

/// Of the time of a render that is short for its size: a filter of a shorter reach takes less.
constexpr double kMostOfTime = 0.3;
/// Who interrupts a render waits no longer for it [s].
constexpr double kPatience = 0.25;

int cores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

} // namespace

Denoising::Denoising(Denoise what, bool png, std::size_t pixels, int threads)
    : pixels_(pixels), threads_(threads > 0 ? std::min(threads, cores()) : cores()),
      reach_(what == Denoise::exr || (what == Denoise::png && png) ? kDenoisingReach : 0) {}

double Denoising::reserve_of_cpu_time(double seconds) {
    if (reach_ > 0) reach_ = denoising_reach(pixels_, kMostOfTime * seconds);
    return reach_ > 0 ? denoising_seconds(pixels_, reach_) : 0;
}

std::optional<Image> Denoising::apply(const Picture& picture, const StopToken& stop, RenderStats& stats) const {
    const bool interrupted = stop.requested();
    int reach = reach_;
    if (interrupted && reach > 0) reach = std::min(reach, denoising_reach(pixels_, kPatience * threads_));
    if (reach == 0) return std::nullopt;
    const StageClock clock(stats, kDenoising);
    std::optional<Image> image;
    try {
        with_threads(threads_, [&] { image = denoise(picture, reach, interrupted ? nullptr : &stop); });
    } catch (const std::bad_alloc&) { // the picture itself is worth more
    }
    return image;
}

} // namespace keyhole
