#include "photonmap/power/camera_subpath.h"

#include "sampling/paths/measure.h"
#include "sampling/paths/random_walk.h"

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

/// A walk through specular vertices to a d1, from which arrived(d1, ray) says whether the camera sub-path is one.
template <class Arrived> struct WalkToD1 : WalkHooks {
    SampleSource& source;
    const Arrived& arrived;
    int left; // vertices that there may be
    LastTwoVertices vertices{};
    bool found = false;

    Vertex& place() { return vertices.place(); }
    bool arrive(Vertex& v, const WalkRay& ray) {
        if (v.point.site != Site::surface) return false;
        if (!stops_at(v, source)) return true;
        found = arrived(v, ray);
        return false;
    }
    bool leave(const Vertex& v, const Continuation& /*next*/, const WalkRay& /*ray*/) {
        return v.specular() && --left > 0;
    }
};

template <class Arrived>
bool walk_to_d1(const Scene& scene, From from, const WalkRay& ray, int max_scatterings, SampleSource& source,
                const Arrived& arrived) {
    WalkToD1<Arrived> walk{{}, source, arrived, max_scatterings};
    // From the eye even the last vertex is asked how light goes on, though nothing follows from that.
    random_walk(scene, from, ray, max_scatterings + (from == From::eye ? 1 : 0), source, walk);
    return walk.found;
}

/// Scattering at d2 and specular vertices as far as d1, then a straight edge to the eye.
bool draw_from_light(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
                     SampleSource& source) {
    const auto next = continue_walk(d2, to_light, From::light, source);
    if (!next || is_specular(next->event)) return false;
    const WalkRay start{&d2.point, &d2.point, next->w};
    return walk_to_d1(scene, From::light, start, max_scatterings, source, [&](const Vertex& d1, const WalkRay& ray) {
        const Vertex eye = sample_eye(scene, source);
        const Vec3 to_eye = direction(d1.point, eye.point);
        return scene.camera().image_point(eye.point, -to_eye) && scatters(d1, -ray.w, to_eye) &&
               scene.visible(d1.point, eye.point);
    });
}

/// From anywhere in the image through at least one specular vertex to d1, then a straight edge to d2.
bool draw_from_eye(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
                   SampleSource& source) {
    const Vertex eye = sample_eye(scene, source);
    const double u0 = source.next(), u1 = source.next();
    const WalkRay start = eye_ray(scene, eye.point, {static_cast<float>(u0), static_cast<float>(u1)});
    return walk_to_d1(scene, From::eye, start, max_scatterings, source, [&](const Vertex& d1, const WalkRay& ray) {
        const Vec3 to_d2 = direction(d1.point, d2.point);
        return ray.last != &eye.point && scatters(d1, to_d2, -ray.w) && scatters(d2, to_light, -to_d2) &&
               scene.visible(d1.point, d2.point);
    });
}

} // namespace

double camera_subpath_density(const Scene& scene, const Path& path, int d2) {
    const int d1 = nth_finite_from_eye(path, 1), eye = path.vertices() - 1;
    const bool straight_to_eye = d1 == eye - 1, straight_to_d2 = d1 == d2 + 1;
    if (d1 <= d2 || !(straight_to_eye || straight_to_d2)) return 0;
    // The lens has a density of its own; the image point is as uniform as the window.
    double density = path.x[eye].pdf_from_eye;
    density *= straight_to_eye ? 1 - share_from_eye(scene) : share_from_eye(scene);
    const int first = straight_to_eye ? d2 + 1 : d1, last = straight_to_eye ? d1 : eye - 1;
    for (int i = first; i <= last; ++i) {
        const Vertex& v = path.x[i];
        density *= (straight_to_eye ? v.pdf_from_light : v.pdf_from_eye) * (ambiguous(v) ? 0.5 : 1.0);
    }
    return density;
}

bool sample_camera_subpath(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
                           SampleSource& source) {
    const double from_eye = share_from_eye(scene);
    return from_eye > 0 && source.next() < from_eye ? draw_from_eye(scene, d2, to_light, max_scatterings, source)
                                                    : draw_from_light(scene, d2, to_light, max_scatterings, source);
}

std::optional<std::int64_t> draws_until_valid(const Scene& scene, const Vertex& d2, const Vec3& to_light,
                                              int max_scatterings, std::int64_t most, SampleSource& source) {
    for (std::int64_t n = 1; n <= most; ++n)
        if (sample_camera_subpath(scene, d2, to_light, max_scatterings, source)) return n;
    return std::nullopt;
}

} // namespace keyhole
