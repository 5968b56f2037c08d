// Records of the irradiance cache that a few rays made too bright.
#pragma once

#include "gather/irradiance_cache.h"

namespace keyhole {

/// Light that one ray in thousands finds makes one record too bright and leaves all others a little too dark: a blotch.
/// Where a record is brighter than the others around say, by more than their noise and no more than its own variance
/// explains, what is too much is shared out among them, in proportion to their light. Irradiance times area keeps its
/// sum, so that no light is lost; what is shared out vanishes as rays become many.
/// @return share of all records that gave some away.
double share_outlying_light(IrradianceCache& cache);

} // namespace keyhole
