// Direct light at a vertex, visibility included.
#pragma once

#include "sampling/walk.h"

namespace keyhole {

/// One sample of an emitter, weighted against a direction of the BSDF that the caller traces [W/(m^2 sr)].
Rgb next_event(const Scene& scene, const Vertex& v, const Vec3& back, SampleSource& source);

/// Both techniques, one sample each.
Rgb direct_light(const Scene& scene, const Vertex& v, const Vec3& back, SampleSource& source);

} // namespace keyhole
