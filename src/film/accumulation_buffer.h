// What a render has gathered so far.
#pragma once

#include "film/film.h"
#include "film/splats.h"

#include <optional>

namespace keyhole {

/// The sums of some of a render's units of work. Sums of different units add up to those of all, bit for bit, in
/// whatever order and grouping: this is what is saved, sent and joined.
struct AccumulationBuffer {
    std::optional<Film> film;           ///< of methods that sample pixels
    std::optional<SplattedLight> drawn; ///< of methods that draw

    enum class Parts { film, drawn, both };
    /// Empty; `width` and `height` in pixels, at least 1.
    AccumulationBuffer(int width, int height, const PixelFilter& filter, Parts parts);

    void merge(const AccumulationBuffer& other);
    void clear();

    std::size_t pixels() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
    /// Of the picture; pixels are counted row by row.
    double luminance(std::size_t pixel) const {
        return (film ? film->mean_luminance(pixel) : 0) + (drawn ? drawn->mean_luminance(pixel) : 0);
    }

    /// The picture, without its sums.
    Picture to_picture() const;

    /// As Picture::sums: "samples" and "drawn".
    std::map<std::string, AccumulatorState> sums() const;
    /// @throws InputError for sums of another kind or size.
    void set_sums(const std::map<std::string, AccumulatorState>& sums);

  private:
    int width_, height_;
};

} // namespace keyhole
