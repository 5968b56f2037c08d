// What user paths bought: chains that use them against chains of the same run that don't.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace keyhole {

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
