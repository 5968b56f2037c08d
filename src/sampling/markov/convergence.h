// Whether independent chains agree with each other: a convergence diagnostic; and what user paths bought: chains that
// use them against chains of the same run that don't.
#pragma once

#include "core/reproducible_sum.h"
#include "core/vec.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace keyhole {

/// Split R-hat (Gelman et al. 2013, section 11.4) of equally long series of at least 4 draws each: every series is cut
/// in halves, and the variance between all halves is compared with the variance within them. About 1 where the series
/// agree with each other and with their own past; infinite where they differ and don't move.
double split_r_hat(std::span<const std::vector<double>> series);

struct ConvergenceDiagnostic {
    double r_hat; ///< the largest of all blocks that are not dark
    double
        error; ///< relative standard error of the blocks' brightness, judged by the groups; mean weighted by brightness
};

/// Watches the brightness of coarse blocks of the image, as independent groups of chains see it in the course of time.
/// add() is thread-safe; the outcome doesn't depend on the order of calls.
class ConvergenceMonitor {
  public:
    static constexpr int kGroups = 8;
    static constexpr int kAcross = 6; ///< blocks along either side of the image

    /// Chain number `chain` deposits luminance `weight` at window point `image`.
    void add(std::int64_t chain, const Vec2& image, double weight) {
        const auto block = [](float x) { return std::clamp(static_cast<int>(x * kAcross), 0, kAcross - 1); };
        const auto group = static_cast<std::size_t>(chain % kGroups);
        sums_[group][static_cast<std::size_t>(block(image.y) * kAcross + block(image.x))].add(weight);
    }

    /// All chains have made `steps` more steps. Not thread-safe.
    void end_round(std::int64_t steps);

    /// None before there are enough rounds to tell.
    std::optional<ConvergenceDiagnostic> diagnostic() const;

  private:
    static constexpr std::size_t kBlocks = static_cast<std::size_t>(kAcross) * kAcross;
    static constexpr std::size_t kMostBatches = 32;

    /// Brightness per step in a batch of the chains.
    struct Batch {
        std::int64_t steps = 0;
        std::array<std::array<double, kBlocks>, kGroups> sums{};
        void operator+=(const Batch& next);
    };
    /// Leaves half as many batches, twice as long, so that any length of chain fits.
    void halve();
    double mean(std::size_t block, std::size_t group) const;

    std::array<std::array<FixedSum, kBlocks>, kGroups> sums_{};
    std::vector<Batch> batches_; ///< the last one may be growing
    std::int64_t length_ = 1;    ///< steps of a full batch
};

/// Variance between chains of the brightness of blocks of the image, for one chain; summed over blocks and relative to
/// the sum of their squared means.
struct GuidanceEffect {
    double with = 0, without = 0;
    std::size_t chains_with = 0, chains_without = 0;
};

/// One chain in eight is a control: it leaves user paths out. Its samples are as good as any; they are used like the
/// others'.
constexpr std::int64_t kControlEvery = 8;
constexpr bool is_control(std::int64_t chain) { return chain % kControlEvery == kControlEvery - 1; }

/// Adds up what each chain deposits, by blocks of the image. Different chains may add at once.
class GuidanceTally {
  public:
    /// Of so many chains, the numbers of which begin with `first`.
    explicit GuidanceTally(std::int64_t chains, std::int64_t first = 0)
        : sums_(static_cast<std::size_t>(chains)), first_(first) {}

    /// `chain` counts from 0.
    void add(std::int64_t chain, const Vec2& image, double weight);
    /// None with fewer than two chains of either sort, or where nothing was deposited.
    std::optional<GuidanceEffect> effect() const;

  private:
    static constexpr int kAcross = 8; ///< blocks along either side of the image
    static constexpr std::size_t kBlocks = static_cast<std::size_t>(kAcross) * kAcross;

    std::vector<std::array<double, kBlocks>> sums_;
    std::int64_t first_;
};

} // namespace keyhole
