// Whether the photons of a pass can be trusted.
#pragma once

#include "core/render_stats.h"
#include "photonmap/irradiance_map.h"
#include "photonmap/photons.h"

namespace keyhole {

/// Puts into `stats` how many photons there are, and how much of the power the brightest 0.1 % of them carry, of the
/// map where that is more.
void report_photons(const Photons& photons, RenderStats& stats);

/// Puts into `stats` how many photons went into an estimate, on average, how many equal ones would be as good, and what
/// share of `asked` was found.
void report_lookups(const IrradianceMap& map, double asked, RenderStats& stats);

/// Puts into `stats` for what share of the visible points the irradiance cache had no record.
void report_starving(double share, RenderStats& stats);

/// Warns by what the last pass left in `stats`: few photons with most of the power, maps too sparse where they are
/// asked, an irradiance cache without answers, no photons at all.
void warn_of_photons(RenderStats& stats);

} // namespace keyhole
