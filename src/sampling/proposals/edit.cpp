#include "sampling/proposals/edit.h"

namespace keyhole {
namespace {

/// The vertex next to the end of a sub-path.
std::optional<Vertex> first_vertex(const Scene& scene, const Vertex& end, From from, const Vec2& image,
                                   SampleSource& source) {
    if (from == From::eye) return next_vertex(scene, end, scene.camera().ray_direction(end.point, image));
    const EmitterRay ray = scene.emitter(end.point.emitter).sample_ray(end.point, source);
    return next_vertex(scene, ray.origin, ray.w);
}

/// Whether x[pivot], now at `from`, is left for `to` just as the old path leaves it towards x[pivot + step].
bool rounded_away(const Path& x, int pivot, int step, const SurfacePoint& from, const SurfacePoint& to) {
    if (from.site == Site::infinite) return to.p == x.x[pivot + step].point.p;
    return direction(from, to) == leaving_direction(x, pivot, step);
}

} // namespace

bool grow(const Scene& scene, SubPath& walk, From from, const Vec2& image, bool kept, SampleSource& source,
          Failure& why) {
    Vertex& v = walk.back();
    std::optional<Vertex> hit;
    if (walk.size() == 1) {
        hit = first_vertex(scene, v, from, image, source);
    } else {
        const auto next = continue_walk(v, direction(v.point, walk[walk.size() - 2].point), from, source);
        if (!next) return why = Failure::absorbed, false;
        if (kept && is_specular(next->event)) return why = Failure::signature, false;
        v.event = next->event;
        hit = next_vertex(scene, v, next->w);
    }
    const bool lost = hit && from == From::light && hit->point.site == Site::infinite;
    if (!hit || lost) return why = Failure::no_hit, false;
    walk.push_back(*hit);
    return true;
}

void assemble(Path& path, const SubPath& light, const SubPath& eye) {
    path.x = light;
    for (std::size_t i = eye.size(); i-- > 0;) path.x.push_back(eye[i]);
}

std::optional<Path> join(const Scene& scene, PathSet set, const SubPath& light, const SubPath& eye, const Vec2& image,
                         Failure& why) {
    std::optional<Vec2> seen_at = image;
    if (eye.size() == 1) {
        seen_at = scene.camera().image_point(eye[0].point, direction(eye[0].point, light.back().point));
        if (!seen_at) return why = Failure::outside_image, std::nullopt;
    }
    std::optional<Path> y(std::in_place);
    assemble(*y, light, eye);
    y->image = *seen_at;
    evaluate(scene, *y, set);
    const bool traced_to_light = light.empty();
    if (y->target > 0 && !traced_to_light && !scene.visible(light.back().point, eye.back().point))
        return why = Failure::blocked, std::nullopt;
    return y;
}

bool retrace_specular_chain(const Scene& scene, SubPath& walk, SurfacePoint origin, Vec3 w, const Path& x, int first,
                            int last, Failure& why) {
    const int step = first <= last ? 1 : -1;
    for (int i = first;; i += step) {
        const auto hit = next_vertex(scene, origin, w);
        if (!hit) return why = Failure::no_hit, false;
        if (i == first && rounded_away(x, first - step, step, walk.back().point, hit->point))
            return why = Failure::unchanged, false;
        walk.push_back(*hit);
        Vertex& v = walk.back();
        v.event = x.x[i].event;
        if (i == last) {
            v.event = Event::finite;
            return i == 0 || v.bsdf.traits().finite || (why = Failure::signature, false);
        }
        const auto lobe = v.bsdf.delta(-w, v.event);
        if (!lobe) return why = Failure::signature, false;
        origin = v.point;
        w = lobe->to;
    }
}

double specular_chain_density(const Path& y, double first_density, int first, int last) {
    const int step = first <= last ? 1 : -1;
    double density = first_density;
    for (int i = first; i != last; i += step) {
        const Vertex& specular = y.x[i];
        const Vertex& next = y.x[i + step];
        const auto lobe = specular.bsdf.delta(leaving_direction(y, i, -step), specular.event);
        if (!lobe || !(lobe->probability > 0)) return 0;
        density *= (step > 0 ? next.pdf_from_light : next.pdf_from_eye) / lobe->probability;
    }
    return density;
}

int next_finite(const Path& path, int i, int step) {
    do i += step;
    while (path.x[i].specular());
    return i;
}

Vec3 leaving_direction(const Path& path, int i, int step) { return direction(path.x[i].point, path.x[i + step].point); }

bool same_events(const Path& x, const Path& y) {
    if (x.x.size() != y.x.size()) return false;
    for (std::size_t i = 0; i < x.x.size(); ++i)
        if (x.x[i].event != y.x[i].event) return false;
    return true;
}

bool can_keep_light(const Scene& scene, const Path& x, int i) {
    if (i == 0) return !scene.emitter(x.x[0].point.emitter).is_delta();
    return !x.x[i].specular();
}

Cut cut_between(const Scene& scene, const Path& x, const Path& y) {
    const int n = x.vertices();
    const int prefix = common_prefix(x, y), suffix = common_suffix(x, y, prefix);
    Cut cut{prefix - 1, suffix <= 1 ? n : n - suffix};
    while (cut.light >= 0 && !can_keep_light(scene, x, cut.light)) --cut.light;
    while (cut.eye < n && !can_keep_eye(x, cut.eye)) ++cut.eye;
    return cut;
}

} // namespace keyhole
