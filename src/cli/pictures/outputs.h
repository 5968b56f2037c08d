// The files that a render makes.
#pragma once

#include "core/choices.h"
#include "film/picture.h"

#include <optional>
#include <string>

namespace keyhole {

/// Where results go; empty: nowhere.
struct Outputs {
    std::string exr, png, stats;
    std::optional<double> exposure{}; ///< of the PNG, in stops; none: tone-mapped
    bool noise_layers = false;        ///< whether the EXR gets the picture's
    Denoise denoise = Denoise::png;   ///< which of them show the picture filtered

    /// Finds out before the render whether all of them can be written.
    /// @throws InputError for names that are no EXR's, that coincide, or that can't be written.
    void check() const;

    /// Writes the files. @throws InputError as check().
    /// @param filtered the picture without grain; an EXR that is to show it has the picture itself as "unfiltered".
    void write(Picture picture, std::optional<Image> filtered, const std::string& stats_json) const;
};

/// Names that nobody gave: the scene's with .exr, in the current folder; the EXR's with .png.
std::string default_exr(const std::string& scene);
std::string default_png(const std::string& exr);

} // namespace keyhole
