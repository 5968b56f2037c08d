// The files that a render makes.
#pragma once

#include "core/choices.h"
#include "film/picture.h"

#include <functional>
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

    /// The picture without grain, with its layers and their noise; none if there is no time for that.
    using Filter = std::function<std::optional<Image>(const Picture&)>;
    /// Writes the files: first what can't be made again. An EXR that shows the picture filtered has what it was as
    /// layer "unfiltered". @param stats_json called last. @throws InputError as check().
    void write(Picture picture, const Filter& filter, const std::function<std::string()>& stats_json) const;
};

/// Names that nobody gave: the scene's with .exr, in the current folder; the EXR's with .png.
std::string default_exr(const std::string& scene);
std::string default_png(const std::string& exr);

} // namespace keyhole
