#include "sampling/paths/bidirectional_tracer.h"

#include "sampling/paths/random_walk.h"

#include <array>

namespace keyhole {
namespace {

/// Whether the other end of paths ever finds the first vertex of a walk.
enum class Start { reachable, unreachable };

double& density(Vertex& v, From from) { return from == From::eye ? v.pdf_from_eye : v.pdf_from_light; }

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

/// A walk that notes what connections have to know of its vertices.
struct SubPathTracing : WalkHooks {
    const From from;
    TracedSubPath& walk;
    double pdf;             // of the ray, per solid angle; of the beam where the walk's end is infinite
    SampleSource* roulette; // null: the walk isn't ended early
    bool start_reachable;   // whether the other end of paths ever finds the first vertex
    Rgb carried{1.0};       // since the start

    Vertex& place() const { return walk.vertices.emplace_back(); }
    void lost() const { walk.vertices.pop_back(); }
    bool arrive(Vertex& v, const WalkRay& ray) const {
        const Vertex& before = walk.vertices[walk.vertices.size() - 2];
        const auto flown = [&ray](const Vertex& to) { return ray.flight ? flight_density(ray.uncollided, to) : 1.0; };
        walk.notes.push_back({ray.throughput, -ray.w, {}, flown(before)});
        density(v, from) = solid_angle_to_area(pdf, *ray.last, v.point, ray.w) * flown(v);
        return v.point.site != Site::infinite;
    }
    bool leave(const Vertex& v, const Continuation& next, const WalkRay& ray) {
        Vertex& before = walk.vertices[walk.vertices.size() - 2];
        const bool reachable = walk.vertices.size() > 2 || start_reachable;
        density(before, from == From::eye ? From::light : From::eye) =
            reachable ? solid_angle_to_area(next.backward, v.point, before.point, ray.w) * walk.notes.back().flight_back
                      : 0.0;
        note_shorter_techniques(walk, from);
        carried *= ray.clear * next.weight;
        pdf = next.forward;
        return true;
    }
    bool survives(Rgb& throughput, SampleSource& /*source*/) {
        if (roulette == nullptr) return true;
        const double q = subpath_survival(carried, walk.vertices.size());
        carried /= q;
        return play_roulette(q, throughput, *roulette);
    }
};

} // namespace

void trace_eye_subpath(const Scene& scene, const Vec2& image, int most_vertices, SampleSource& source,
                       SampleSource* roulette, TracedSubPath& walk) {
    walk.clear();
    Vertex& eye = walk.vertices.emplace_back();
    sample_eye(scene, source, eye);
    eye.pdf_from_eye = scene.camera().eye_pdf();
    walk.notes.emplace_back().throughput = Rgb(1.0);
    if (most_vertices == 1) return;
    const WalkRay ray = eye_ray(scene, eye.point, image);
    // Light never hits the lens by chance.
    SubPathTracing tracing{{}, From::eye, walk, scene.camera().direction_pdf(ray.w), roulette, false};
    random_walk(scene, From::eye, ray, most_vertices - 1, source, tracing);
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
    const auto light = emit_light(scene, x0.point, x0.pdf_from_light, source);
    if (!light || is_black(light->power)) return;
    const bool reachable = !scene.emitter(x0.point.emitter).is_delta();
    SubPathTracing tracing{{}, From::light, walk, light->ray.pdf, roulette, reachable};
    random_walk(scene, From::light, {&light->ray.origin, &x0.point, light->ray.w, light->power}, most_vertices - 1,
                source, tracing);
}

SubPathPair& SubPathPair::scratch(std::size_t room) {
    thread_local std::array<SubPathPair, 2> rooms;
    return rooms[room];
}

} // namespace keyhole
