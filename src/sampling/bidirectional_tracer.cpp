#include "sampling/bidirectional_tracer.h"

#include <algorithm>

namespace keyhole {
namespace {

/// Roulette by the walk's own throughput, once it has gone on for a while.
double survival_probability(const Rgb& carried, std::size_t vertices) {
    if (vertices < 4) return 1;
    return std::clamp(luminance(carried), 0.1, 0.95);
}

/// A ray that leaves the end of a walk.
struct Departure {
    SurfacePoint from; ///< where to trace from; on its beam if the walk's end is infinite
    Vec3 w;
    double pdf;     ///< per solid angle; of the beam where the end is infinite
    Rgb throughput; ///< of the walk, having left
};

double& density(Vertex& v, From from) { return from == From::eye ? v.pdf_from_eye : v.pdf_from_light; }

/// Appends the next vertex. False, and nothing appended, where there is none.
bool append_next(const Scene& scene, const Departure& ray, TracedSubPath& walk) {
    walk.vertices.resize(walk.vertices.size() + 1);
    if (!next_vertex(scene, ray.from, ray.w, walk.vertices.back())) {
        walk.vertices.pop_back();
        return false;
    }
    walk.throughput.push_back(ray.throughput);
    return true;
}

/// Goes on from the last vertex until the walk is lost or full.
void extend(const Scene& scene, TracedSubPath& walk, From from, Departure ray, std::size_t most, SampleSource& source,
            SampleSource* roulette) {
    const From other = from == From::eye ? From::light : From::eye;
    Rgb carried(1.0); // since the start
    while (walk.vertices.size() < most) {
        if (!append_next(scene, ray, walk)) return;
        Vertex &v = walk.vertices.back(), &before = walk.vertices[walk.vertices.size() - 2];
        const Rgb clear = scene.transmittance(ray.from, v.point);
        walk.throughput.back() *= clear;
        density(v, from) = solid_angle_to_area(ray.pdf, before.point, v.point);
        if (v.point.site == Site::infinite || walk.vertices.size() == most) return;
        const auto next = continue_walk(v, -ray.w, from, source);
        if (!next) return;
        v.event = next->event;
        density(before, other) = solid_angle_to_area(next->backward, v.point, before.point);
        carried *= clear * next->weight;
        const double q = roulette != nullptr ? survival_probability(carried, walk.vertices.size()) : 1.0;
        if (q < 1 && roulette->next() >= q) return;
        carried /= q;
        ray = {v.point, next->w, next->forward, walk.throughput.back() * next->weight / q};
    }
}

} // namespace

void trace_eye_subpath(const Scene& scene, const Vec2& image, int most_vertices, SampleSource& source,
                       SampleSource* roulette, TracedSubPath& walk) {
    walk.clear();
    Vertex eye = sample_eye(scene, source);
    eye.pdf_from_eye = scene.camera().eye_pdf();
    walk.push_back(eye, Rgb(1.0));
    if (most_vertices > 1) {
        const Vec3 w = scene.camera().ray_direction(eye.point, image);
        extend(scene, walk, From::eye, {eye.point, w, scene.camera().direction_pdf(w), Rgb(1.0)},
               static_cast<std::size_t>(most_vertices), source, roulette);
    }
    walk.vertices[0].pdf_from_light = 0; // light never hits the lens by chance
}

void trace_light_subpath(const Scene& scene, int most_vertices, SampleSource& source, SampleSource* roulette,
                         TracedSubPath& walk) {
    walk.clear();
    if (most_vertices < 1) return;
    auto x0 = sample_emitter(scene, source);
    if (!x0 || !(x0->pdf > 0)) return;
    x0->vertex.pdf_from_light = x0->pdf;
    walk.push_back(x0->vertex, Rgb(1 / x0->pdf));
    if (most_vertices == 1) return;
    const SurfacePoint& point = x0->vertex.point;
    const Emitter& emitter = scene.emitter(point.emitter);
    const EmitterRay ray = emitter.sample_ray(point, source);
    const Rgb leaving = emitter.radiance(point, ray.w) * (point.abs_cos(ray.w) / (x0->pdf * ray.pdf));
    if (!(ray.pdf > 0) || is_black(leaving)) return;
    extend(scene, walk, From::light, {ray.origin, ray.w, ray.pdf, leaving}, static_cast<std::size_t>(most_vertices),
           source, roulette);
    if (emitter.is_delta()) walk.vertices[0].pdf_from_eye = 0;
}

SubPathPair& SubPathPair::scratch() {
    thread_local SubPathPair pair;
    return pair;
}

} // namespace keyhole
