// Emitters: where paths begin.
#pragma once

#include "core/rng.h"
#include "scene/surface_point.h"

#include <memory>
#include <vector>

namespace keyhole {

/// A point drawn on an emitter.
struct EmitterPoint {
    SurfacePoint point;
    double pdf; ///< per area; per solid angle for an infinite point; 1 for a point in space
};

struct EmitterDirection {
    Vec3 w;     ///< unit, away from the emitter
    double pdf; ///< per solid angle
};

/// Immutable and thread-safe. Points that it makes carry its index in the scene.
class Emitter {
  public:
    virtual ~Emitter() = default;

    /// Luminous power in W (luminance of the RGB power).
    virtual double power() const = 0;
    /// True where a ray can't hit the emitter, so that only sampling its points finds it.
    virtual bool is_delta() const = 0;
    virtual EmitterPoint sample_point(SampleSource& source) const = 0;
    /// Density with which sample_point() makes `point`, a point of this emitter.
    virtual double point_pdf(const SurfacePoint& point) const = 0;
    virtual EmitterDirection sample_direction(const SurfacePoint& point, SampleSource& source) const = 0;
    virtual double direction_pdf(const SurfacePoint& point, const Vec3& w) const = 0;
    /// Radiance leaving `point` along `w` [W/(m^2 sr)]; radiant intensity [W/sr] for a point in space.
    virtual Rgb radiance(const SurfacePoint& point, const Vec3& w) const = 0;
    virtual const char* kind() const = 0;
};

/// Chooses an emitter with probability proportional to a weight.
class EmitterDistribution {
  public:
    EmitterDistribution() = default;
    explicit EmitterDistribution(const std::vector<double>& weights);

    bool empty() const { return cumulative_.empty(); }
    /// Index for u in [0,1). Not to be called when empty.
    std::uint32_t sample(double u) const;
    double probability(std::uint32_t i) const { return cumulative_[i + 1] - cumulative_[i]; }

  private:
    std::vector<double> cumulative_; // n + 1 entries from 0 to 1, or none
};

} // namespace keyhole
