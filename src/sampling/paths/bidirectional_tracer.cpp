#include "sampling/paths/bidirectional_tracer.h"

#include "sampling/paths/random_walk.h"
#include "scene/emitters/emitters.h"

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

Connection::Connection(const Scene& scene, TracedSubPath& light, int s, TracedSubPath& eye, int t, const Vec2& image)
    : scene_(&scene), light_(&light), eye_(&eye), s_(s), t_(t), image_(image) {
    const Vertex& z = vertex(s);
    if (s == 0) {
        possible_ = z.point.is_emitter();
        return;
    }
    // Whatever they did as walks, the two ends of a connection scatter finitely.
    const Vertex& y = vertex(s - 1);
    possible_ = (s == 1 || y.bsdf.traits().finite) && (t == 1 || z.bsdf.traits().finite);
    if (!possible_) return;
    to_eye_ = direction(y.point, z.point);
    if (t > 1) return;
    possible_ = s > 1 || !is_invisible(scene.emitter(y.point.emitter));
    if (!possible_) return;
    const auto p = scene.camera().image_point(z.point, -to_eye_);
    possible_ = p.has_value();
    if (p) image_ = *p;
}

const Vertex& Connection::vertex(int i) const {
    return i < s_ ? light_->vertices[static_cast<std::size_t>(i)]
                  : eye_->vertices[static_cast<std::size_t>(s_ + t_ - 1 - i)];
}

bool Connection::is_d2_covered(const PathSet& set) const {
    const int d2 = diffuse().d2;
    Vertex& v = d2 < s_ ? light_->vertices[static_cast<std::size_t>(d2)]
                        : eye_->vertices[static_cast<std::size_t>(s_ + t_ - 1 - d2)];
    return is_covered(set.coverage, v, direction(v.point, vertex(d2 - 1).point));
}

/// What leaves the light sub-path towards the eye's, and the densities that this changes.
Rgb Connection::leave_light(const Vec3& to_eye) {
    const Vertex& y = vertex(s_ - 1);
    const auto end = static_cast<std::size_t>(s_) - 1;
    if (s_ == 1) {
        const Emitter& emitter = scene_->emitter(y.point.emitter);
        from_light_[0] = solid_angle_to_area(emitter.ray_pdf(y.point, to_eye), y.point, vertex(1).point, to_eye);
        return light_->notes[0].throughput * emitter.radiance(y.point, to_eye);
    }
    const Vertex& before = vertex(s_ - 2);
    const Vec3& back = light_->notes[end].back;
    const ScatterValue f = scatter(y.point, y.bsdf, Event::finite, back, to_eye);
    from_light_[0] = solid_angle_to_area(f.pdf_to_eye, y.point, vertex(s_).point, to_eye);
    const bool unreachable = s_ == 2 && scene_->emitter(before.point.emitter).is_delta();
    from_eye_[1] =
        unreachable ? 0.0
                    : solid_angle_to_area(f.pdf_to_light, y.point, before.point, back) * light_->notes[end].flight_back;
    return light_->notes[end].throughput * f.value;
}

/// What the eye asks of light that arrives from the light sub-path, and the densities that this changes.
Rgb Connection::leave_eye(const Vec3& to_light) {
    const Vertex &z = vertex(s_), &y = vertex(s_ - 1);
    const bool unreachable = s_ == 1 && scene_->emitter(y.point.emitter).is_delta();
    if (t_ == 1) {
        const double pdf = scene_->camera().direction_pdf(to_light);
        from_light_[0] = 0; // light never hits the lens by chance
        from_eye_[0] = unreachable ? 0.0 : solid_angle_to_area(pdf, z.point, y.point, to_light);
        return Rgb(pdf);
    }
    const SurfacePoint& next = vertex(s_ + 1).point;
    const TracedSubPath::Note& note = eye_->notes[static_cast<std::size_t>(t_) - 1];
    const Vec3& back = note.back;
    const ScatterValue f = scatter(z.point, z.bsdf, Event::finite, to_light, back);
    from_eye_[0] = unreachable ? 0.0 : solid_angle_to_area(f.pdf_to_light, z.point, y.point, to_light);
    from_light_[1] = solid_angle_to_area(f.pdf_to_eye, z.point, next, back) * note.flight_back;
    return note.throughput * f.value;
}

Rgb Connection::join() {
    if (s_ > 0) {
        const SurfacePoint &y = vertex(s_ - 1).point, &z = vertex(s_).point;
        const double geometry = geometry_term(y, z, to_eye_);
        if (!(geometry > 0)) return Rgb(0.0);
        const Rgb from_light = leave_light(to_eye_);
        if (is_black(from_light)) return from_light;
        const Rgb carried = from_light * leave_eye(-to_eye_) * geometry;
        if (!scene_->has_scattering_media()) return carried * scene_->transmittance(y, z);
        const Attenuation attenuation = scene_->attenuation(y, z);
        from_light_[0] *= flight_density(attenuation.uncollided, vertex(s_));
        from_eye_[0] *= flight_density(attenuation.uncollided, vertex(s_ - 1));
        return carried * attenuation.transmittance;
    }
    const SurfacePoint &x0 = vertex(0).point, &x1 = vertex(1).point;
    const Emitter& emitter = scene_->emitter(x0.emitter);
    const TracedSubPath::Note& note = eye_->notes[static_cast<std::size_t>(t_) - 1];
    from_light_[0] = emitter_point_pdf(*scene_, x0);
    from_light_[1] = solid_angle_to_area(emitter.ray_pdf(x0, note.back), x0, x1, note.back) * note.flight_back;
    return note.throughput * emitter.radiance(x0, note.back);
}

Rgb Connection::value(MisHeuristic heuristic) {
    const Rgb carried = join();
    return luminance(carried) > 0 ? carried * weight(heuristic) : Rgb(0.0);
}

double Connection::pdf_from_light(int i) const {
    return i == s_ ? from_light_[0] : i == s_ + 1 ? from_light_[1] : vertex(i).pdf_from_light;
}

double Connection::pdf_from_eye(int i) const {
    return i == s_ - 1 ? from_eye_[0] : i == s_ - 2 ? from_eye_[1] : vertex(i).pdf_from_eye;
}

double Connection::density_ratio(int k) const {
    if (k > 0 && (specular(k - 1) || specular(k))) return 0;
    double ratio = 1;
    for (int i = k; i < s_; ++i) ratio *= pdf_from_eye(i) / vertex(i).pdf_from_light;
    for (int i = s_; i < k; ++i) ratio *= pdf_from_light(i) / vertex(i).pdf_from_eye;
    return ratio;
}

/// Those that make less from the light than this one, and more from the eye. What vertices change is a product (Veach
/// 1997, section 10.2), and the connection changes the last two of either side only.
ShorterTechniques Connection::shorter_light() const {
    if (s_ == 0) return {};
    const Vertex& y = vertex(s_ - 1);
    const double last = from_eye_[0] / y.pdf_from_light;
    if (s_ == 1) return ShorterTechniques().longer(last, true);
    const Vertex& before = vertex(s_ - 2);
    return light_->notes[static_cast<std::size_t>(s_) - 2]
        .shorter.longer(from_eye_[1] / before.pdf_from_light, s_ == 2 || joinable(vertex(s_ - 3), before))
        .longer(last, !before.specular());
}

/// Those that make less from the eye than this one. All of them make the eye.
ShorterTechniques Connection::shorter_eye() const {
    if (t_ == 1) return {};
    const Vertex &z = vertex(s_), &before = vertex(s_ + 1);
    return eye_->notes[static_cast<std::size_t>(t_) - 2]
        .shorter.longer(from_light_[1] / before.pdf_from_eye, t_ > 2 && joinable(before, vertex(s_ + 2)))
        .longer(from_light_[0] / z.pdf_from_eye, !before.specular());
}

double Connection::weight(MisHeuristic heuristic) const {
    const ShorterTechniques light = shorter_light(), eye = shorter_eye();
    if (heuristic == MisHeuristic::balance) return 1 / (1 + light.sum + eye.sum);
    if (heuristic == MisHeuristic::power) return 1 / (1 + light.squares + eye.squares);
    return light.largest < 1 && eye.largest <= 1 ? 1 : 0; // of equals, the first
}

bool Connection::visible() const { return s_ == 0 || scene_->visible(vertex(s_ - 1).point, vertex(s_).point, to_eye_); }

Path Connection::path() const {
    Path path;
    for (int i = 0; i < s_ + t_; ++i) path.x.push_back(vertex(i));
    path.x[static_cast<std::size_t>(s_)].event = Event::finite;
    if (s_ > 0) path.x[static_cast<std::size_t>(s_) - 1].event = Event::finite;
    path.image = image_;
    measure(*scene_, path);
    return path;
}

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

SubPathPair& trace_both_subpaths(const Scene& scene, const Vec2& image, int max_scatterings, SampleSource& from_eye,
                                 SampleSource& from_light, SampleSource* roulette) {
    SubPathPair& pair = SubPathPair::scratch();
    const auto by = [&](SampleSource& own) { return roulette != nullptr ? roulette : &own; };
    const int most = std::min(max_scatterings, kMaxScatterings);
    trace_eye_subpath(scene, image, most + 2, from_eye, by(from_eye), pair.eye);
    trace_light_subpath(scene, most + 1, from_light, by(from_light), pair.light);
    return pair;
}

SubPathPair& SubPathPair::scratch(std::size_t room) {
    thread_local std::array<SubPathPair, 2> rooms;
    return rooms[room];
}

} // namespace keyhole
