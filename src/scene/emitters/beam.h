// Parallel light from infinity, as wide as the scene.
#pragma once

#include "scene/emitter.h"
#include "scene/warp.h"

namespace keyhole {

/// Density of sample_beam() per area of the beam's cross-section [1/m^2].
inline double beam_pdf(const BoundingSphere& scene) {
    return kInvPi / (static_cast<double>(scene.radius) * scene.radius);
}

/// A ray along `w`, uniform over the cross-section of the beam that holds `scene`; it starts outside.
inline EmitterRay sample_beam(const BoundingSphere& scene, const Vec3& w, SampleSource& source) {
    const double u0 = source.next(), u1 = source.next();
    const Vec2 d = uniform_disc(u0, u1) * scene.radius;
    EmitterRay ray;
    ray.origin.site = Site::point;
    ray.origin.p = scene.center - w * scene.radius + Frame(w).to_world(Vec3(d.x, d.y, 0));
    ray.w = w;
    ray.pdf = beam_pdf(scene);
    return ray;
}

} // namespace keyhole
