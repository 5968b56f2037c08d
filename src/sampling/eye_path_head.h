// The first part of paths from the eye: what final gather and its importance know of them.
#pragma once

#include "sampling/walk.h"

namespace keyhole {

/// Traces a path from window point `image` as far as d2, its second non-specular vertex, with at most `max_scatterings`
/// vertices, and tells visit(vertex, to_eye, throughput, finite) of each vertex on a surface that could be d1 or d2:
/// `finite` is the number of non-specular ones before it, `throughput` the RGB importance that arrives there (window
/// density 1).
template <class Visit>
void trace_eye_path_head(const Scene& scene, const Vec2& image, int max_scatterings, SampleSource& source,
                         const Visit& visit) {
    Vertex v = sample_eye(scene, source);
    Vec3 w = scene.camera().ray_direction(v.point, image);
    Rgb throughput(1.0);
    int finite = 0;
    for (int i = 0; i < max_scatterings && finite < 2; ++i) {
        const auto hit = next_vertex(scene, v, w);
        if (!hit || hit->point.site != Site::surface) return;
        throughput *= scene.transmittance(v.point, hit->point);
        v = *hit;
        if (v.bsdf.traits().finite) visit(v, -w, throughput, finite);
        const auto next = continue_walk(v, -w, From::eye, source);
        if (!next) return;
        finite += is_specular(next->event) ? 0 : 1;
        throughput *= next->weight;
        w = next->w;
    }
}

} // namespace keyhole
