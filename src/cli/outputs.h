// The files that a render makes.
#pragma once

#include "film/picture.h"

#include <optional>
#include <string>

namespace keyhole {

/// Where results go; empty: nowhere.
struct Outputs {
    std::string exr, png, stats;
    std::optional<double> exposure{}; ///< of the PNG, in stops; none: tone-mapped

    /// Finds out before the render whether all of them can be written.
    /// @throws InputError for names that are no EXR's, that coincide, or that can't be written.
    void check() const;

    /// Writes the files. @throws InputError as check().
    void write(const Picture& picture, const std::string& stats_json) const;
};

/// Names that nobody gave: the scene's with .exr, in the current folder; the EXR's with .png.
std::string default_exr(const std::string& scene);
std::string default_png(const std::string& exr);

} // namespace keyhole
