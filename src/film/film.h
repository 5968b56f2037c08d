// The film: sums of samples by pixel and layer.
#pragma once

#include "core/pixel_sample.h"
#include "core/render_stats.h"
#include "film/filter.h"
#include "film/picture.h"
#include "film/pixel_sums.h"

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace keyhole {

/// Pixels are means of their samples, each of weight 1 (see PixelFilter). The sums don't depend on the order of
/// samples, nor on how they were shared out among films that are merged. Thread safety: add() for different pixels may
/// run at once; a pixel belongs to one thread at a time.
class Film {
  public:
    struct Layer {
        const char* name;
        int channels;
        bool is_signed; ///< may be negative
    };
    /// The layers of a PixelSample, in its order.
    static constexpr std::array<Layer, 6> kLayers{{{"direct", 3, false},
                                                   {"indirect", 3, false},
                                                   {"caustic", 3, false},
                                                   {"albedo", 3, false},
                                                   {"normal", 3, true},
                                                   {"depth", 1, false}}};

    /// @param width,height in pixels, at least 1.
    Film(int width, int height, const PixelFilter& filter = PixelFilter());

    /// What samples are to be distributed as around their pixels' centres.
    const PixelFilter& filter() const { return filter_; }

    /// Adds a sample of one of the halves to pixel (x, y). A sample with a number that is not finite, or negative where
    /// it can't be, is dropped as a whole, so that the layers stay means over the same samples; it is counted for each
    /// layer at fault.
    void add(int x, int y, const PixelSample& sample, Half half = Half::first);

    /// Adds the samples of another film of the same size.
    void merge(const Film& other);
    /// Forgets all samples, and what was dropped.
    void clear();

    /// The sums as they stand in memory, and back.
    /// @throws InputError for words of another size than this film's.
    AccumulatorState words() const;
    void set_words(const AccumulatorState& words);

    /// The means, and as layers "noise.NAME" half the difference between halves (PixelSums::half_differences()).
    /// "beauty" is direct + indirect + caustic. Pixels without samples are 0.
    Picture to_picture() const;

    /// Samples dropped because of layer kLayers[i].
    std::uint64_t dropped(std::size_t i) const { return dropped_[i].load(std::memory_order_relaxed); }
    /// Pixels without a sample.
    std::uint64_t empty_pixels() const;

    double samples_per_pixel() const;
    /// Mean luminance of a pixel's samples; pixels are counted row by row.
    double mean_luminance(std::size_t pixel) const;

    /// Puts "empty pixels" among the values, and dropped samples among the warnings.
    void report(RenderStats& stats) const;

  private:
    static constexpr std::size_t kChannels = 16;
    using Pixel = PixelSums<kChannels>;
    using Channels = Pixel::Channels; ///< of all layers, one after the other

    static Channels channels(const PixelSample& sample);
    std::size_t index(int x, int y) const;

    int width_, height_;
    PixelFilter filter_;
    std::vector<Pixel> pixels_;
    std::array<std::atomic<std::uint64_t>, kLayers.size()> dropped_{};
};

} // namespace keyhole
