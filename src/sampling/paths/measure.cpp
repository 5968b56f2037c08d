#include "sampling/paths/measure.h"

#include "sampling/paths/walk.h"
#include "scene/emitters/emitters.h"

namespace keyhole {

/// A delta lobe has a density only up to the factor that its delta function would have. The factors are chosen so that
/// one `value` serves both directions: contribution over density is then T / (eta^2 p) from the eye and, with the
/// shading-normal factor, T / p from the light (Veach 1997, sections 5.2 and 5.3).
ScatterValue scatter_specular(const SurfacePoint& point, const Bsdf& bsdf, Event event, const Vec3& to_light,
                              const Vec3& to_eye) {
    const auto from_eye = bsdf.delta(to_eye, event);
    const auto from_light = bsdf.delta(to_light, event);
    if (!from_eye || !from_light) return {};
    const Vec3& ns = bsdf.shading_normal();
    const double ns_light = std::abs(ns.dot(to_light)), ns_eye = std::abs(ns.dot(to_eye));
    const double ng_light = point.abs_cos(to_light);
    if (ns_eye == 0 || ng_light == 0) return {};
    const double eta2 = from_eye->eta * from_eye->eta; // (light's side / eye's side)^2
    return {from_eye->coefficient * (ns_light / (ng_light * ns_eye)), from_eye->probability * eta2 * ns_light / ns_eye,
            from_light->probability};
}

double emitter_point_pdf(const Scene& scene, const SurfacePoint& point) {
    if (!point.is_emitter() || scene.emitter_distribution().empty()) return 0;
    return scene.emitter_distribution().probability(point.emitter) * scene.emitter(point.emitter).point_pdf(point);
}

void measure(const Scene& scene, Path& path) {
    auto& x = path.x;
    const std::size_t eye = x.size() - 1;
    Vec3 to_eye = direction(x[0].point, x[1].point);

    // The light's end.
    const Emitter& emitter = scene.emitter(x[0].point.emitter);
    Attenuation attenuation = scene.attenuation(x[0].point, x[1].point);
    x[0].value = emitter.radiance(x[0].point, to_eye) * attenuation.transmittance;
    x[0].pdf_from_light = emitter_point_pdf(scene, x[0].point);
    x[1].pdf_from_light = solid_angle_to_area(emitter.ray_pdf(x[0].point, to_eye), x[0].point, x[1].point) *
                          flight_density(attenuation.uncollided, x[1]);
    Rgb f = x[0].value * geometry_term(x[0].point, x[1].point);

    for (std::size_t i = 1; i < eye; ++i) {
        Vertex& v = x[i];
        const Vec3 to_light = -to_eye;
        to_eye = direction(v.point, x[i + 1].point);
        const ScatterValue s = scatter(v.point, v.bsdf, v.event, to_light, to_eye);
        x[i - 1].pdf_from_eye = solid_angle_to_area(s.pdf_to_light, v.point, x[i - 1].point) *
                                flight_density(attenuation.uncollided, x[i - 1]);
        attenuation = scene.attenuation(v.point, x[i + 1].point);
        v.value = s.value * attenuation.transmittance;
        x[i + 1].pdf_from_light = solid_angle_to_area(s.pdf_to_eye, v.point, x[i + 1].point) *
                                  flight_density(attenuation.uncollided, x[i + 1]);
        f *= v.value * geometry_term(v.point, x[i + 1].point);
    }

    // The eye's end: the importance is the density of the eye edge, so that the mean over the window is measured.
    const Camera& camera = scene.camera();
    const double direction_pdf = camera.direction_pdf(-to_eye);
    x[eye].pdf_from_eye = camera.eye_pdf();
    x[eye].value = Rgb(camera.eye_pdf() * direction_pdf);
    x[eye - 1].pdf_from_eye = solid_angle_to_area(direction_pdf, x[eye].point, x[eye - 1].point) *
                              flight_density(attenuation.uncollided, x[eye - 1]);
    x[eye].pdf_from_light = 0; // light never hits the lens by chance
    if (emitter.is_delta()) x[0].pdf_from_eye = 0;
    const bool unseen = eye == 1 && is_invisible(emitter);
    path.contribution = unseen ? Rgb(0.0) : f * x[eye].value;
}

void evaluate(const Scene& scene, Path& path, PathSet set) {
    const bool stored = set.find_storage(path).kind != PhotonKind::none;
    path.target = 0;
    if (!set.everything && !stored) return;
    measure(scene, path);
    path.target = set.target(path.contribution, path.image);
}

} // namespace keyhole
