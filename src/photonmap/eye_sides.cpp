#include "photonmap/eye_sides.h"

#include "sampling/measure.h"
#include "sampling/walk.h"

namespace keyhole {
namespace {

/// A vertex that may be d1 or, by its specular part, stand before it: it is taken for either half of the time.
bool ambiguous(const Vertex& v) { return v.bsdf.traits().finite && v.bsdf.traits().delta; }

} // namespace

double literal_factor(const Path& path, int d2, const Rgb& flux) {
    const auto eye = static_cast<std::size_t>(path.vertices()) - 1;
    Rgb rest = flux * path.x[eye].value;
    for (auto i = static_cast<std::size_t>(d2); i < eye; ++i)
        rest *= path.x[i].value * geometry_term(path.x[i].point, path.x[i + 1].point);
    const double visible = luminance(rest);
    return visible > 0 && std::isfinite(1 / visible) ? 1 / visible : 0.0;
}

double eye_side_density(const Path& path, int d2) {
    const int d1 = nth_finite_from_eye(path, 1), eye = path.vertices() - 1;
    if (d1 != eye - 1 || d1 <= d2) return 0;
    double density = path.x[static_cast<std::size_t>(eye)].pdf_from_eye;
    for (int i = d2 + 1; i <= d1; ++i) {
        const Vertex& v = path.x[static_cast<std::size_t>(i)];
        density *= v.pdf_from_light * (ambiguous(v) ? 0.5 : 1.0);
    }
    return density;
}

bool sample_eye_side(const Scene& scene, const Vertex& d2, const Vec3& to_light, int max_scatterings,
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
        if (!v.bsdf.traits().finite || (ambiguous(v) && source.next() < 0.5)) continue;
        const Vertex eye = sample_eye(scene, source);
        const Vec3 to_eye = direction(v.point, eye.point);
        if (!scene.camera().image_point(eye.point, -to_eye)) return false;
        if (is_black(scatter(v.point, v.bsdf, Event::finite, back, to_eye).value)) return false;
        return scene.visible(v.point, eye.point);
    }
    return false;
}

std::optional<std::int64_t> draws_until_valid(const Scene& scene, const Vertex& d2, const Vec3& to_light,
                                              int max_scatterings, std::int64_t most, SampleSource& source) {
    for (std::int64_t n = 1; n <= most; ++n)
        if (sample_eye_side(scene, d2, to_light, max_scatterings, source)) return n;
    return std::nullopt;
}

} // namespace keyhole
