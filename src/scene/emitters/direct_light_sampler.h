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

    /// With which sample() chooses the emitter.
    virtual double probability(const SurfacePoint& at, std::uint32_t emitter) const = 0;
    /// A point as sample() makes it where it chooses that emitter, whose probability must not be 0. Its density is that
    /// of sample(). `u` in [0,1) is a number more.
    virtual EmitterPoint sample_of(const SurfacePoint& at, std::uint32_t emitter, double u,
                                   SampleSource& source) const = 0;
};

} // namespace keyhole
