// Light that chains and light sub-paths draw, which choose their pixels themselves.
#pragma once

#include "core/inline_vector.h"
#include "core/reproducible_sum.h"
#include "core/vec.h"
#include "film/filter.h"
#include "film/picture.h"
#include "film/pixel_sums.h"
#include "sampling/paths/path.h"

#include <array>
#include <vector>

namespace keyhole {

/// Sums of what chains deposit, by pixel, unscaled: what they are worth is known at the end only. add() is thread-safe,
/// and the sums don't depend on the order of its calls.
class SplatFilm {
  public:
    enum class Layer { direct, indirect, caustic };
    static constexpr std::size_t kPerPixel = 9;

    static Layer layer_of(LightClass light) {
        switch (light) {
        case LightClass::emission:
        case LightClass::direct:
            return Layer::direct;
        case LightClass::caustic:
            return Layer::caustic;
        case LightClass::second:
        case LightClass::indirect:
            break;
        }
        return Layer::indirect;
    }

    /// @param width,height in pixels, at least 1.
    /// @param brightness about that of the splats: sums are in units of a power of two near it. Else, 1.
    SplatFilm(int width, int height, const PixelFilter& filter = PixelFilter(), double brightness = 1);

    /// Adds `value` at `position` [pixels] to all pixels whose filter reaches it. Positions may lie outside the film.
    void add(const Vec2& position, Layer layer, const Rgb& value);

    /// The sums: of a pixel (row by row) layer by layer, of a layer R, G and B.
    std::array<double, kPerPixel> sums(std::size_t pixel) const;
    std::size_t pixels() const { return sums_.size() / kPerPixel; }
    void clear();

  private:
    /// The pixels along one axis that a splat at `position` meets, of `size`, and what the filter gives them.
    struct Footprint {
        int first;
        InlineVector<double, 34> weights; // filters reach 16 pixels at most
    };
    Footprint footprint(float position, int size) const;

    int width_, height_;
    double reach_;
    double unit_;                ///< of the sums, which keep to a fixed range
    std::vector<double> filter_; ///< its density at kNodes + 1 even distances from 0 to its reach
    std::vector<FixedSum> sums_; ///< by layer, pixel and channel: a splat meets few cache lines
};

/// Adds up the pictures that units of work have drawn, each an estimate of the whole; the picture is their mean. It
/// doesn't depend on their order, nor on how they were shared out among sums that are merged.
class SplattedLight {
  public:
    /// @param width,height in pixels, at least 1.
    SplattedLight(int width, int height);

    /// Adds scale times what one unit, of one of the halves, has drawn on a film of this size.
    void add(const SplatFilm& unit, double scale, Half half = Half::first);
    /// Adds the units of another sum of this size.
    void merge(const SplattedLight& other);
    void clear();

    /// The sums as they stand in memory, and back. @throws InputError for words of another size.
    AccumulatorState words() const;
    void set_words(const AccumulatorState& words);

    /// Luminance of the mean; pixels are counted row by row.
    double mean_luminance(std::size_t pixel) const;
    /// Adds the mean to the layers "direct", "indirect" and "caustic", and to "beauty"; and what halves of the units
    /// differ in to the noise of the former.
    void add_to(Picture& picture) const;

  private:
    using Pixel = PixelSums<SplatFilm::kPerPixel>;

    std::vector<Pixel> pixels_;
};

} // namespace keyhole
