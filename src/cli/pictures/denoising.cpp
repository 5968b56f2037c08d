#include "cli/pictures/denoising.h"

#include "core/parallel.h"
#include "session/stage_clock.h"

#include <algorithm>
#include <thread>

namespace keyhole {
namespace {

constexpr Stage kDenoising{"denoising"};

/// Of the time of a render that is short for its size: a filter of a shorter reach takes less.
constexpr double kMostOfTime = 0.3;
/// Who interrupts a render waits no longer for it [s].
constexpr double kPatience = 0.5;

} // namespace

Denoising::Denoising(Denoise what, bool png, std::size_t pixels, int threads)
    : pixels_(pixels),
      threads_(threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))),
      reach_(what == Denoise::exr || (what == Denoise::png && png) ? kDenoisingReach : 0) {}

double Denoising::reserve_of_cpu_time(double seconds) {
    if (reach_ == 0) return 0;
    reach_ = denoising_reach(pixels_, kMostOfTime * seconds);
    return denoising_seconds(pixels_, reach_);
}

std::optional<Image> Denoising::apply(const Picture& picture, bool interrupted, RenderStats& stats) const {
    const int reach =
        interrupted && reach_ > 0 ? std::min(reach_, denoising_reach(pixels_, kPatience * threads_)) : reach_;
    if (reach == 0) return std::nullopt;
    const StageClock clock(stats, kDenoising);
    std::optional<Image> image;
    with_threads(threads_, [&] { image = denoise(picture, reach); });
    return image;
}

} // namespace keyhole
