#include "session/pixel_sampling.h"

namespace keyhole {
namespace {

/// Rounds of a pilot: fewer tell nothing, more would come too late to gain by.
constexpr std::int64_t kLeastPilot = 8, kMostPilot = 64;
/// Of all rounds, or of the time, in between.
constexpr std::int64_t kShareOfPilot = 8; // one in so many

bool is_adaptive(const Settings& settings, const WorkPartition& share) {
    return settings.adaptive && settings.passes == 1 && settings.spp >= 2 * kLeastPilot && share.is_whole_render();
}

} // namespace

PixelSampling::PixelSampling(const Scene& scene, const Settings& settings, const WorkPartition& share,
                             StreamPurpose purpose)
    : scene_(scene), seed_(settings.seed), purpose_(purpose),
      longest_pilot_(std::clamp(settings.spp / kShareOfPilot, kLeastPilot, kMostPilot)) {
    const ImageWindow& window = scene.camera().window();
    pixels_ = static_cast<std::uint64_t>(window.width) * static_cast<std::uint64_t>(window.height);
    if (is_adaptive(settings, share)) density_.emplace(window.width, window.height);
}

std::pair<int, int> PixelSampling::pixel_of_turn(std::int64_t n) {
    // Of the bits of n, from the lowest: which diagonal of 2 x 2, which half of it, and the same within.
    const auto bit = [n](int i) { return static_cast<int>(n >> i & 1); };
    const int a = bit(0), b = bit(1), c = bit(2), d = bit(3);
    return {2 * (a ^ b) + (c ^ d), 2 * a + c};
}

Range PixelSampling::samples_of(std::size_t pixel, std::int64_t round) const {
    if (!density_ || !density_->is_decided()) return {round, round + 1};
    const double shift = Rng(seed_, StreamPurpose::sampling_density, pixel).next();
    const std::int64_t after = round - pilot_;
    return {pilot_ + density_->samples_before(pixel, after, shift),
            pilot_ + density_->samples_before(pixel, after + 1, shift)};
}

void PixelSampling::end_of_round(std::int64_t round, const RunContext& context) {
    if (!density_ || density_->is_decided()) return;
    const std::int64_t taken = round + 1;
    const bool long_enough =
        context.by_time && at_begin_ - context.seconds_left() > at_begin_ / static_cast<double>(kShareOfPilot);
    if (taken < longest_pilot_ && !(taken >= kLeastPilot && long_enough)) return;
    pilot_ = taken;
    density_->decide();
}

void PixelSampling::report(RenderStats& stats) const {
    if (density_ && density_->is_decided())
        stats.values["adaptive sampling, squared error over that of even samples"] = density_->error_over_even();
}

} // namespace keyhole
