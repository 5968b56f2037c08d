// Pages, each from the files of its folder page/, which the build puts into the program.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

/// HTML with all styles and scripts in it, up to where the data stand, and from there on.
struct PageParts {
    std::string_view before_data, after_data;

    /// The page with these data, JSON.
    std::string with(std::string data) const;
};
extern const PageParts kChartPage, kInspectionPage;

/// A PNG, of pixels with 3 channels (sRGB) or 1 (grey).
std::string png_uri(int width, int height, int channels, const std::vector<std::uint8_t>& pixels);

} // namespace keyhole
