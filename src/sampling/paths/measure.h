// Contribution and densities of a whole path.
//
// Every vertex counts as if it had an area measure of its own, specular ones included, with the delta functions left
// out of contribution and densities alike. The ratio of a contribution to a density of the same path is then the true
// one: what a specular chain does to the measure stands in both and cancels. Neither means anything alone. Directions
// at a specular vertex have densities scaled so that this holds when traced from the light and from the eye; through
// glass the two differ by the squared refractive index and the ratio of cosines.
#pragma once

#include "sampling/paths/path_set.h"
#include "scene/scene.h"

namespace keyhole {

/// Scattering at one vertex between two directions.
struct ScatterValue {
    Rgb value{0.0};          ///< with the shading-normal factor |wi.ns| / |wi.ng|, to go with geometry terms in ng
    double pdf_to_light = 0; ///< density per solid angle of continuing to the light's side, tracing from the eye
    double pdf_to_eye = 0;   ///< density per solid angle of continuing to the eye's side, tracing from the light
};

/// scatter() for specular events.
ScatterValue scatter_specular(const SurfacePoint& point, const Bsdf& bsdf, Event event, const Vec3& to_light,
                              const Vec3& to_eye);

/// Whether two directions lie on one side of a surface by its geometry and on both by its shading normal, or the other
/// way round. A BSDF in the frame of the shading normal would send light through a wall that reflects, and closed rooms
/// would be lit from outside (Veach 1997, 5.3).
inline bool changes_sides(const Vec3& ng, const Vec3& ns, const Vec3& a, const Vec3& b) {
    return ((ng.dot(a) > 0) == (ng.dot(b) > 0)) != ((ns.dot(a) > 0) == (ns.dot(b) > 0));
}

/// Scattering of kind `event` at `point` from the direction towards the light into that towards the eye.
inline ScatterValue scatter(const SurfacePoint& point, const Bsdf& bsdf, Event event, const Vec3& to_light,
                            const Vec3& to_eye) {
    if (is_specular(event)) return scatter_specular(point, bsdf, event, to_light, to_eye);
    const double ng_light = point.abs_cos(to_light);
    if (ng_light == 0) return {};
    const Bsdf::Finite f = bsdf.finite(to_light, to_eye);
    if (point.site != Site::surface) return {f.value, f.pdf_to_light, f.pdf_to_eye};
    const Vec3& ns = bsdf.shading_normal();
    const bool through = changes_sides(point.ng, ns, to_light, to_eye);
    const double shading = through ? 0 : std::abs(static_cast<double>(ns.dot(to_light))) / ng_light;
    return {f.value * shading, f.pdf_to_light, f.pdf_to_eye};
}

/// Fills in values and densities of all vertices, and the contribution f (radiance, over the window; visibility is
/// assumed). x, the events and `image` are the input. Veach 1997, chapter 8.
void measure(const Scene& scene, Path& path);

/// measure(), where the path stores a photon, and the target of a chain that samples `set`.
void evaluate(const Scene& scene, Path& path, PathSet set);

/// Density of the emitter point x0 as a first vertex from the light: choice of emitter times its point density.
double emitter_point_pdf(const Scene& scene, const SurfacePoint& point);

} // namespace keyhole
