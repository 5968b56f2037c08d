// Emitters: where paths begin.
#pragma once

#include "core/rng.h"
#include "scene/surface_point.h"

#include <memory>
#include <optional>
#include <vector>

namespace keyhole {

/// A point drawn on an emitter.
struct EmitterPoint {
    SurfacePoint point;
    double pdf; ///< per area; per solid angle for an infinite point; 1 where there is nothing to choose
};

/// A ray that leaves an emitter.
struct EmitterRay {
    SurfacePoint origin; ///< where to trace from: the emitter's point, or for an infinite one a place on its beam
                         ///< before everything in the scene
    Vec3 w;              ///< unit, away from the emitter
    double pdf = 0;      ///< per solid angle; from an infinite point per area of the beam's cross-section
};

/// Holds all geometry of a scene; world space, metres.
struct BoundingSphere {
    Vec3 center{0, 0, 0};
    float radius = 1;
};

/// Where an emitter is and where its light may go.
struct EmitterBounds {
    Vec3 lower{0, 0, 0}, upper{0, 0, 0}; ///< box, world space
    Vec3 axis{0, 0, 1};                  ///< unit; its normals lie within `spread` of this
    double spread = kPi;                 ///< [rad]
    double reach = kPi / 2;              ///< how far from a normal light goes [rad]
    double intensity = 0;                ///< luminous, along the normal [W/sr]
};

/// Immutable once its scene is built, and thread-safe. The scene writes its index into the points that it makes.
class Emitter {
  public:
    virtual ~Emitter() = default;

    /// What its points are: a light on a surface, in one point, or infinitely far away.
    virtual Site site() const = 0;
    /// True where a ray can't hit the emitter, so that only sampling its points finds it.
    virtual bool is_delta() const = 0;
    /// Told once by the scene, before anything is asked: beams from infinity are as wide as the scene.
    virtual void enclose(const BoundingSphere& /*scene*/) {}

    /// Luminous power in W (luminance of the RGB power) sent towards the scene.
    virtual double power() const = 0;
    virtual EmitterPoint sample_point(SampleSource& source) const = 0;
    /// Density with which sample_point() makes `point`, a point of this emitter.
    virtual double point_pdf(const SurfacePoint& point) const = 0;
    virtual EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const = 0;
    /// Density with which sample_ray() leaves `point` along `w`, in the measure of EmitterRay::pdf.
    virtual double ray_pdf(const SurfacePoint& point, const Vec3& w) const = 0;
    /// Radiance leaving `point` along `w` [W/(m^2 sr)]; radiant intensity [W/sr] for a point in space; for a delta
    /// emitter at infinity irradiance on a plane across the beam [W/m^2].
    virtual Rgb radiance(const SurfacePoint& point, const Vec3& w) const = 0;
    /// None for an emitter at infinity.
    virtual std::optional<EmitterBounds> bounds() const { return std::nullopt; }
    virtual const char* kind() const = 0;
};

/// Whether rays that miss everything meet this emitter.
inline bool is_environment(const Emitter& emitter) { return emitter.site() == Site::infinite && !emitter.is_delta(); }

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
