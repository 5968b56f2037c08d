// The page of a chart, from the files of page/, which the build puts into the program.
#pragma once

#include <string_view>

namespace keyhole {

/// HTML with all styles and scripts in it, up to where the data stand, and from there on.
extern const std::string_view kPageBeforeData, kPageAfterData;

} // namespace keyhole
