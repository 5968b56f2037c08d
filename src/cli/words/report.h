// What a render says at its end.
#pragma once

#include "core/render_stats.h"

namespace keyhole {

/// On stderr, a line each.
void print_warnings(const RenderStats& stats);

/// Stages, photons and the ledger of proposals, as tables on stderr.
void print_report(const RenderStats& stats);

} // namespace keyhole
