// How many rays each record of an irradiance cache is to get.
#pragma once

#include <span>
#include <vector>

namespace keyhole {

/// Rays of records that have had `had` each, when `more` for each, on average, are shared out in proportion to
/// `weights`: none loses what it had, and none has more than 64 times that in all. With weights of width times noise,
/// the squared error of a picture, a sum of (width * noise)^2 / rays, is least.
std::vector<int> share_rays(std::span<const double> weights, int had, double more);

} // namespace keyhole
