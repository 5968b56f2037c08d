// The mean of what chains and light sub-paths draw, over units of work.
#pragma once

#include "core/reproducible_sum.h"
#include "film/splats.h"

#include <array>
#include <vector>

namespace keyhole {

/// Adds up the pictures that units of work have drawn, each an estimate of the whole; the picture is their mean. It
/// doesn't depend on their order, nor on how they were shared out among sums that are merged.
class DrawnLight {
  public:
    /// @param width,height in pixels, at least 1.
    DrawnLight(int width, int height);

    /// Adds scale times what one unit has drawn on a film of this size.
    void add(const SplatFilm& unit, double scale);
    /// Adds the units of another sum of this size.
    void merge(const DrawnLight& other);
    void clear();

    /// The sums as they stand in memory, and back. @throws InputError for words of another size.
    PixelWords words() const;
    void set_words(const PixelWords& words);

    /// Luminance of the mean; pixels are counted row by row.
    double mean_luminance(std::size_t pixel) const;
    /// Adds the mean to the layers "direct", "indirect" and "caustic", and to "beauty".
    void add_to(Picture& picture) const;

  private:
    struct Pixel {
        ReproducibleSums<SplatFilm::kPerPixel> sums;
        std::uint64_t units = 0;
    };
    using Means = std::array<double, SplatFilm::kPerPixel>;
    static Means means(const Pixel& pixel);

    std::vector<Pixel> pixels_;
};

} // namespace keyhole
