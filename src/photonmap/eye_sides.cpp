#include "photonmap/eye_sides.h"

#include "sampling/measure.h"
#include "sampling/walk.h"

namespace keyhole {
namespace {

/// A vertex that may be d1 or, by its specular part, stand before it: it is taken for either half of the time.
bool ambiguous(const Vertex& v) { return v.bsdf.traits().finite && v.bsdf.traits().delta; }

/// Share of the draws that begin at the eye: where nothing is specular none need to.
double share_from_eye(const Scene& scene) { return scene.traits().delta ? 0.25 : 0.0; }

/// Whether a walk that has come to `v` takes it for a vertex of finite density, or goes on by a specular part.
bool stops_at(const Vertex& v, SampleSource& source) {
    return v.bsdf.traits().finite && !(ambiguous(v) && source.next() < 0.5);
}

bool scatters(const Vertex& v, const Vec3& to_light, const Vec3& to_eye) {
    return !is_black(scatter(v.point, v.bsdf, Event::finite, to_light, to_eye).value);
}

/// Scattering at d2 and specular vertices as far as d1, then a straight edge to the eye.
bool draw_from_light(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
                     SampleSource& source) {
    Vertex v = d2;
    Vec3 back = to_light;
    for (int i = 0; i < max_scatterings; ++i) {
        const auto next = v.bsdf.sample(back, source);
        // From d2 light goes on by its finite part, from the vertices after it by a specular one.
        if (!next || is_specular(next->event) != (i > 0)) return false;
        const auto hit = next_vertex(scene, v, next->to);
        if (!hit || hit->point.site != Site::surface) return false;
        v = *hit;
        back = -next->to;
        if (!stops_at(v, source)) continue;
        const Vertex eye = sample_eye(scene, source);
        const Vec3 to_eye = direction(v.point, eye.point);
        return scene.camera().image_point(eye.point, -to_eye) && scatters(v, back, to_eye) &&
               scene.visible(v.point, eye.point);
    }
    return false;
}

/// From anywhere in the image through at least one specular vertex to d1, then a straight edge to d2.
bool draw_from_eye(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
                   SampleSource& source) {
    Vertex v = sample_eye(scene, source);
    const double u0 = source.next(), u1 = source.next();
    Vec3 w = scene.camera().ray_direction(v.point, {static_cast<float>(u0), static_cast<float>(u1)});
    for (int i = 0; i < max_scatterings; ++i) {
        const auto hit = next_vertex(scene, v, w);
        if (!hit || hit->point.site != Site::surface) return false;
        v = *hit;
        if (stops_at(v, source)) {
            const Vec3 to_d2 = direction(v.point, d2.point);
            return i > 0 && scatters(v, to_d2, -w) && scatters(d2, to_light, -to_d2) &&
                   scene.visible(v.point, d2.point);
        }
        const auto next = v.bsdf.sample(-w, source);
        if (!next || !is_specular(next->event)) return false;
        w = next->to;
    }
    return false;
}

} // namespace

double literal_factor(const Path& path, int d2, const Rgb& flux) {
    const auto eye = static_cast<std::size_t>(path.vertices()) - 1;
    Rgb rest = flux * path.x[eye].value;
    for (auto i = static_cast<std::size_t>(d2); i < eye; ++i)
        rest *= path.x[i].value * geometry_term(path.x[i].point, path.x[i + 1].point);
    const double visible = luminance(rest);
    return visible > 0 && std::isfinite(1 / visible) ? 1 / visible : 0.0;
}

double eye_side_density(const Scene& scene, const Path& path, int d2) {
    const int d1 = nth_finite_from_eye(path, 1), eye = path.vertices() - 1;
    const bool straight_to_eye = d1 == eye - 1, straight_to_d2 = d1 == d2 + 1;
    if (d1 <= d2 || !(straight_to_eye || straight_to_d2)) return 0;
    // The lens has a density of its own; the image point is as uniform as the window.
    double density = path.x[static_cast<std::size_t>(eye)].pdf_from_eye;
    density *= straight_to_eye ? 1 - share_from_eye(scene) : share_from_eye(scene);
    const int first = straight_to_eye ? d2 + 1 : d1, last = straight_to_eye ? d1 : eye - 1;
    for (int i = first; i <= last; ++i) {
        const Vertex& v = path.x[static_cast<std::size_t>(i)];
        density *= (straight_to_eye ? v.pdf_from_light : v.pdf_from_eye) * (ambiguous(v) ? 0.5 : 1.0);
    }
    return density;
}

bool sample_eye_side(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
                     SampleSource& source) {
    const double from_eye = share_from_eye(scene);
    return from_eye > 0 && source.next() < from_eye ? draw_from_eye(scene, d2, to_light, max_scatterings, source)
                                                    : draw_from_light(scene, d2, to_light, max_scatterings, source);
}

std::optional<std::int64_t> draws_until_valid(const Scene& scene, const Vertex& d2, const Vec3& to_light,
                                              int max_scatterings, std::int64_t most, SampleSource& source) {
    for (std::int64_t n = 1; n <= most; ++n)
        if (sample_eye_side(scene, d2, to_light, max_scatterings, source)) return n;
    return std::nullopt;
}

} // namespace keyhole
