// Whether the photons of a pass can be trusted.
#pragma once

#include "core/render_stats.h"
#include "photonmap/photons.h"

namespace keyhole {

/// Puts into `stats` how much of the power the brightest 0.1 % of the photons carry, of the map where that is more.
void report_power(const Photons& photons, RenderStats& stats);

/// Puts into `stats` how many photons went into an estimate, on average, and what share that is of those asked for.
void report_lookups(double found, double asked, RenderStats& stats);

/// Warns by what the last pass left in `stats`: few photons with most of the power, maps too sparse where they are
/// asked, no photons at all.
void warn_of_photons(RenderStats& stats);

} // namespace keyhole
