#include "sampling/bidirectional_tracer.h"

#include <algorithm>
#include <array>

namespace keyhole {
namespace {

/// Roulette by the walk's own throughput, once it has gone on for a while.
double survival_probability(const Rgb& carried, std::size_t vertices) {
    if (vertices < 4) return 1;
    return std::clamp(luminance(carried), 0.1, 0.95);
}

/// A ray that leaves the end of a walk.
struct Departure {
    const SurfacePoint* from; ///< where to trace from; on its beam if the walk's end is infinite
    Vec3 w;
    double pdf;     ///< per solid angle; of the beam where the end is infinite
    Rgb throughput; ///< of the walk, having left
};

/// Whether the other end of paths ever finds the first vertex of a walk.
enum class Start { reachable, unreachable };

double& density(Vertex& v, From from) { return from == From::eye ? v.pdf_from_eye : v.pdf_from_light; }

/// Appends the next vertex. False, and nothing appended, where there is none.
bool append_next(const Scene& scene, const Departure& ray, TracedSubPath& walk) {
    if (!next_vertex(scene, *ray.from, ray.w, walk.vertices.emplace_back())) {
        walk.vertices.pop_back();
        return false;
    }
    TracedSubPath::Note& note = walk.notes.emplace_back();
    note.throughput = ray.throughput;
    note.back = -ray.w;
    return true;
}

/// Notes at the last vertex which techniques make less than what lies before it. To be asked once it is known how the
/// walk goes on there.
void note_shorter_techniques(TracedSubPath& walk, From from) {
    const std::size_t last = walk.vertices.size() - 1;
    const Vertex& before = walk.vertices[last - 1];
    const bool cut = last == 1 ? from == From::light : joinable(walk.vertices[last - 2], before);
    const double forward = from == From::eye ? before.pdf_from_eye : before.pdf_from_light,
                 backward = from == From::eye ? before.pdf_from_light : before.pdf_from_eye;
    walk.notes[last].shorter = walk.notes[last - 1].shorter.longer(backward / forward, cut);
}

/// Goes on from the last vertex until the walk is lost or full.
void extend(const Scene& scene, TracedSubPath& walk, From from, Start start, Departure ray, std::size_t most,
            SampleSource& source, SampleSource* roulette) {
    const From other = from == From::eye ? From::light : From::eye;
    Rgb carried(1.0); // since the start
    while (walk.vertices.size() < most) {
        if (!append_next(scene, ray, walk)) return;
        Vertex &v = walk.vertices.back(), &before = walk.vertices[walk.vertices.size() - 2];
        const Rgb clear = scene.transmittance(before.point, v.point); // the ray of an infinite emitter starts nearer
        TracedSubPath::Note& note = walk.notes.back();
        note.throughput *= clear;
        density(v, from) = solid_angle_to_area(ray.pdf, before.point, v.point, ray.w);
        if (v.point.site == Site::infinite || walk.vertices.size() == most) return;
        const auto next = continue_walk(v, -ray.w, from, source);
        if (!next) return;
        v.event = next->event;
        density(before, other) = walk.vertices.size() == 2 && start == Start::unreachable
                                     ? 0.0
                                     : solid_angle_to_area(next->backward, v.point, before.point, ray.w);
        note_shorter_techniques(walk, from);
        carried *= clear * next->weight;
        const double q = roulette != nullptr ? survival_probability(carried, walk.vertices.size()) : 1.0;
        if (q < 1 && roulette->next() >= q) return;
        carried /= q;
        ray = {&v.point, next->w, next->forward, note.throughput * next->weight / q};
    }
}

} // namespace

void trace_eye_subpath(const Scene& scene, const Vec2& image, int most_vertices, SampleSource& source,
                       SampleSource* roulette, TracedSubPath& walk) {
    walk.clear();
    Vertex& eye = walk.vertices.emplace_back();
    sample_eye(scene, source, eye);
    eye.pdf_from_eye = scene.camera().eye_pdf();
    walk.notes.emplace_back().throughput = Rgb(1.0);
    if (most_vertices > 1) {
        const Vec3 w = scene.camera().ray_direction(eye.point, image);
        // Light never hits the lens by chance.
        extend(scene, walk, From::eye, Start::unreachable, {&eye.point, w, scene.camera().direction_pdf(w), Rgb(1.0)},
               static_cast<std::size_t>(most_vertices), source, roulette);
    }
}

void trace_light_subpath(const Scene& scene, int most_vertices, SampleSource& source, SampleSource* roulette,
                         TracedSubPath& walk) {
    walk.clear();
    if (most_vertices < 1) return;
    Vertex& x0 = walk.vertices.emplace_back();
    x0.pdf_from_light = sample_emitter(scene, source, x0);
    if (!(x0.pdf_from_light > 0)) {
        walk.clear();
        return;
    }
    walk.notes.emplace_back().throughput = Rgb(1 / x0.pdf_from_light);
    if (most_vertices == 1) return;
    const Emitter& emitter = scene.emitter(x0.point.emitter);
    const EmitterRay ray = emitter.sample_ray(x0.point, source);
    const Rgb leaving = emitter.radiance(x0.point, ray.w) * (x0.point.abs_cos(ray.w) / (x0.pdf_from_light * ray.pdf));
    if (!(ray.pdf > 0) || is_black(leaving)) return;
    extend(scene, walk, From::light, emitter.is_delta() ? Start::unreachable : Start::reachable,
           {&ray.origin, ray.w, ray.pdf, leaving}, static_cast<std::size_t>(most_vertices), source, roulette);
}

SubPathPair& SubPathPair::scratch(std::size_t room) {
    thread_local std::array<SubPathPair, 2> rooms;
    return rooms[room];
}

} // namespace keyhole
