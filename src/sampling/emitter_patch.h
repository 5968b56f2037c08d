// A small part of an emitter that user paths begin on.
#pragma once

#include "core/rng.h"
#include "scene/scene.h"

namespace keyhole {

/// The surroundings of a point on an emitter, or all of it. Within a radius: on a mesh the triangle that the point lies
/// in, shrunk towards it; on a sphere a cap. Of a light in a point that point. A density is so known everywhere without
/// tracing a ray. The scene must outlive it.
class EmitterPatch {
  public:
    /// @param center a point on an emitter that is not infinite, as rays find or emitters sample it.
    /// @param radius no point of the patch lies farther from the centre, along the surface [m]; none: the whole emitter
    EmitterPatch(const Scene& scene, const SurfacePoint& center, std::optional<double> radius = std::nullopt);

    const SurfacePoint& center() const { return center_; }
    /// Uniform by area.
    SurfacePoint sample(SampleSource& source) const;
    /// Density of sample() [1/m^2], 1 for a light in a point; 0 for points elsewhere.
    double pdf(const SurfacePoint& point) const;

  private:
    bool is_whole() const { return whole_ || center_.site != Site::surface; }
    Vec2 barycentric(const Vec3& p) const;

    const Scene* scene_;
    SurfacePoint center_;
    bool whole_;
    Vec2 center_barycentric_{0, 0};
    double scale_ = 1;   ///< of the triangle
    double cosine_ = -1; ///< of half the cap's angle
    double area_ = 1;
};

} // namespace keyhole
