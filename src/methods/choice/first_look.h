// A picture for a render that was stopped before it had one.
#pragma once

#include "methods/render.h"

namespace keyhole {

/// Whether at least one pixel has a sample, or a share at least one unit of work.
bool has_picture(const RenderResult& result);

/// Pixels without a sample; 0 where the method doesn't count them.
double empty_pixels(const RenderResult& result);

/// A sample a pixel by path tracing, as far as nine tenths of a second go, from the top. Says so in a warning.
RenderResult first_look(const Scene& scene, const Settings& settings);

} // namespace keyhole
