// The first part of paths from the eye: what final gather and its importance know of them.
#pragma once

#include "sampling/paths/random_walk.h"

namespace keyhole {

/// What lies between the eye and a vertex.
struct EyePast {
    int finite = 0;   ///< non-specular vertices
    int specular = 0; ///< specular ones
};

/// The hooks of trace_eye_path_head().
template <class Visit> struct EyePathHead : WalkHooks {
    const Visit& visit;
    LastTwoVertices vertices{};
    EyePast past{};

    Vertex& place() { return vertices.place(); }
    bool arrive(Vertex& v, const WalkRay& ray) const {
        if (v.point.site != Site::surface) return false;
        if (v.bsdf.traits().finite) visit(v, -ray.w, ray.throughput, past);
        return true;
    }
    bool leave(const Vertex& v, const Continuation& /*next*/, const WalkRay& /*ray*/) {
        if (v.specular())
            ++past.specular;
        else
            ++past.finite;
        return past.finite < 2;
    }
};

/// Traces a path from window point `image` as far as d2, its second non-specular vertex, with at most `max_scatterings`
/// vertices, and tells visit(vertex, to_eye, throughput, past) of each vertex on a surface that could be d1 or d2:
/// `past` is the EyePast before it, `throughput` the RGB importance that arrives there (window
/// density 1).
template <class Visit>
void trace_eye_path_head(const Scene& scene, const Vec2& image, int max_scatterings, SampleSource& source,
                         const Visit& visit) {
    const Vertex eye = sample_eye(scene, source);
    EyePathHead<Visit> hooks{{}, visit};
    random_walk(scene, From::eye, eye_ray(scene, eye.point, image), max_scatterings, source, hooks);
}

} // namespace keyhole
