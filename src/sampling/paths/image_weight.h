// How much each part of the picture counts when chains and photons are shared out.
#pragma once

#include "core/progress.h"
#include "core/vec.h"

#include <array>
#include <cstdint>

namespace keyhole {

class Scene;

/// A weight for every window point: the reciprocal of a coarse, filtered picture's brightness, so that dark pixels draw
/// as many samples as bright ones and their relative errors even out (Veach 1997, section 11.4.3 "two-stage MLT";
/// Hoberock and Hart 2010 "Arbitrary Importance Functions for Metropolis Light Transport"). Positive everywhere, and
/// therefore free to be wrong: it moves noise, and biases nothing. Immutable and thread-safe.
class ImageWeight {
  public:
    static constexpr int kCells = 32; ///< along each side of the window
    /// Weights lie within this factor of 1: what a coarse picture says of its darkest cells is mostly noise.
    static constexpr double kMost = 16;
    using Cells = std::array<double, std::size_t{kCells} * kCells>;

    /// `luminance` of the cells, row by row; only its ratios matter. A black picture weighs the same everywhere.
    explicit ImageWeight(const Cells& luminance);

    /// At window point `image`; 1 at the median of the picture's lit cells.
    double operator()(const Vec2& image) const { return cells_[index(image)]; }

    /// The cell of a window point. The window may be left a little.
    static std::size_t index(const Vec2& image);

  private:
    Cells cells_;
};

/// From path tracing of all light, direct light included: it is the whole of a pixel that its error is measured by. The
/// same on any number of threads.
ImageWeight measure_image_weight(const Scene& scene, int max_scatterings, std::uint64_t seed,
                                 const RunContext& context);

} // namespace keyhole
