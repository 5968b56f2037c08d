// Light from infinity, in parallel beams as wide as the scene.
#pragma once

#include "scene/emitter.h"
#include "scene/warp.h"

namespace keyhole {

/// An emitter whose points are directions.
class InfiniteEmitter : public Emitter {
  public:
    Site site() const override { return Site::infinite; }
    bool is_delta() const override { return false; }
    void enclose(const BoundingSphere& scene) override { scene_ = scene; }

    /// A ray along the beam, uniform over its cross-section; it starts outside the scene.
    EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const override {
        const double u0 = source.next(), u1 = source.next();
        const Vec3 w = point.ng;
        const Vec2 d = uniform_disc(u0, u1) * scene_.radius;
        EmitterRay ray;
        ray.origin.site = Site::point;
        ray.origin.p = scene_.center - w * scene_.radius + Frame(w).to_world(Vec3(d.x, d.y, 0));
        ray.w = w;
        ray.pdf = beam_pdf();
        return ray;
    }
    double ray_pdf(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return beam_pdf(); }
    const char* kind() const override { return "environment"; }

  protected:
    /// Per area of a beam's cross-section [1/m^2].
    double beam_pdf() const { return kInvPi / (static_cast<double>(scene_.radius) * scene_.radius); }

  private:
    BoundingSphere scene_;
};

} // namespace keyhole
