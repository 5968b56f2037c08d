// How points on emitters are drawn for light at a place.
#pragma once

#include "scene/emitter.h"

namespace keyhole {

/// Draws points on emitters for next-event estimation at a place. Immutable and thread-safe.
class DirectLightSampler {
  public:
    virtual ~DirectLightSampler() = default;

    /// A point on an emitter whose light may arrive at `at`. Its density is that of EmitterPoint times the probability
    /// of the emitter; 0: none was found. Not to be called where nothing emits.
    virtual EmitterPoint sample(const SurfacePoint& at, SampleSource& source) const = 0;
    /// Density with which sample() makes the emitter's point `x0` for `at`.
    virtual double pdf(const SurfacePoint& at, const SurfacePoint& x0) const = 0;
};

} // namespace keyhole
