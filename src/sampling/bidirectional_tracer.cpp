#include "sampling/bidirectional_tracer.h"

#include <algorithm>
#include <array>

namespace keyhole {
namespace {

/// Roulette by the walk's own throughput, once it has gone on for a while.
double survival_probability(const Rgb& throughput, std::size_t vertices) {
    if (vertices < 4) return 1;
    return std::clamp(luminance(throughput), 0.1, 0.95);
}

/// Goes on from the last vertex until the walk is lost or full.
void extend(const Scene& scene, TracedSubPath& walk, From from, Vec3 w, SurfacePoint origin, int max_scatterings,
            SampleSource& source) {
    Rgb throughput(1.0);
    double survival = 1;
    while (static_cast<int>(walk.vertices.size()) <= max_scatterings) {
        Vertex start;
        start.point = origin;
        const auto hit = next_vertex(scene, start, w);
        if (!hit) return;
        throughput *= scene.transmittance(origin, hit->point);
        walk.push_back(*hit, survival, throughput);
        if (hit->point.site == Site::infinite) return;
        Vertex& v = walk.vertices.back();
        const auto next = continue_walk(v, -w, from, source);
        if (!next) return;
        v.event = next->event;
        throughput *= next->weight;
        const double q = survival_probability(throughput, walk.vertices.size());
        if (q < 1 && source.next() >= q) return;
        throughput /= q;
        survival *= q;
        w = next->w;
        origin = v.point;
    }
}

} // namespace

TracedSubPath trace_eye_subpath(const Scene& scene, const Vec2& image, int max_scatterings, SampleSource& source) {
    TracedSubPath walk;
    walk.push_back(sample_eye(scene, source), 1, Rgb(1.0));
    const SurfacePoint eye = walk.vertices[0].point;
    // One vertex more than scatterings: the last may lie on an emitter.
    const int most = std::min(max_scatterings + 1, kMaxScatterings + 1);
    extend(scene, walk, From::eye, scene.camera().ray_direction(eye, image), eye, most, source);
    return walk;
}

TracedSubPath trace_light_subpath(const Scene& scene, int max_scatterings, SampleSource& source) {
    TracedSubPath walk;
    const auto x0 = sample_emitter(scene, source);
    if (!x0 || !(x0->pdf > 0)) return walk;
    walk.push_back(x0->vertex, 1, Rgb(1.0));
    const EmitterRay ray = scene.emitter(x0->vertex.point.emitter).sample_ray(x0->vertex.point, source);
    if (ray.pdf > 0) extend(scene, walk, From::light, ray.w, ray.origin, max_scatterings, source);
    return walk;
}

std::optional<Path> join_subpaths(const Scene& scene, const SubPath& light, int s, const SubPath& eye, int t,
                                  const Vec2& image, PathSet set) {
    const Vertex& z = eye[static_cast<std::size_t>(t) - 1];
    if (s == 0 && !z.point.is_emitter()) return std::nullopt;
    // Whatever they did as walks, the two ends of a joint scatter finitely.
    if (s > 1 && !light[static_cast<std::size_t>(s) - 1].bsdf.traits().finite) return std::nullopt;
    if (s > 0 && t > 1 && !z.bsdf.traits().finite) return std::nullopt;

    std::optional<Path> path(std::in_place);
    for (int i = 0; i < s; ++i) path->x.push_back(light[static_cast<std::size_t>(i)]);
    if (s > 0) path->x.back().event = Event::finite;
    for (int i = t - 1; i >= 0; --i) path->x.push_back(eye[static_cast<std::size_t>(i)]);
    path->x[static_cast<std::size_t>(s)].event = Event::finite;
    if (!in_set(light_class(*path), set)) return std::nullopt;
    path->image = image;
    if (t == 1) {
        const auto p = scene.camera().image_point(z.point, leaving_direction(*path, path->vertices() - 1, -1));
        if (!p) return std::nullopt;
        path->image = *p;
    }
    measure(scene, *path);
    if (!(luminance(path->contribution) > 0)) return std::nullopt;
    if (s > 0 && !scene.visible(light[static_cast<std::size_t>(s) - 1].point, z.point)) return std::nullopt;
    return path;
}

TechniqueWeight technique_weight(const Path& path, int s) {
    const std::size_t n = path.x.size();
    std::array<double, kMaxScatterings + 3> density{}; // of technique k; first that of the part traced from the eye
    density[n] = 1;
    for (std::size_t k = n; k-- > 0;) density[k] = density[k + 1] * path.x[k].pdf_from_eye;
    double from_light = 1;
    for (std::size_t k = 0; k < n; ++k) { // the eye itself is never reached from the light
        const bool joint = k == 0 || joinable(path.x[k - 1], path.x[k]);
        density[k] *= joint ? from_light : 0.0;
        from_light *= path.x[k].pdf_from_light;
    }
    const double own = density[static_cast<std::size_t>(s)];
    if (!(own > 0)) return {0, 0};
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += (density[k] / own) * (density[k] / own);
    return {own, 1 / sum};
}

} // namespace keyhole
