// Pixels that a filter would make larger instead of less noisy.
#pragma once

#include "film/denoise/filter_part.h"

#include <array>
#include <vector>

namespace keyhole {

struct Outlier {
    int x, y;
    std::array<float, 3> mean; ///< that it had
    bool confirmed;            ///< both halves of the samples have it
};

/// Finds pixels so bright that each, spread over those within `reach`, would make a disc of half their brightness more:
/// a lamp smaller than a pixel, or a sample out of thousands. Puts the mean of the others into their place, without
/// noise.
std::vector<Outlier> take_out_outliers(FilterPart& part, int reach);

} // namespace keyhole
