// Next-event estimation and its counterpart, with multiple importance sampling (Veach 1997, section 9.2).
#pragma once

#include "sampling/paths/measure.h"
#include "sampling/paths/walk.h"

#include <optional>

namespace keyhole {

/// Power heuristic with exponent 2 of a technique against one other (Veach 1997, eq. 9.13).
inline double mis_power(double pdf, double other) {
    if (!(pdf > 0)) return 0;
    const double r = other / pdf;
    return 1 / (1 + r * r);
}

struct DirectLight {
    Vertex x0;
    Rgb value; ///< radiance scattered towards `back` [W/(m^2 sr)] if nothing stands or lies between, MIS weight
               ///< included
};

/// How points on emitters are drawn where nothing was learned: the emitter by the light tree, the point by the emitter.
EmitterPoint sample_by_light_tree(const Scene& scene, const SurfacePoint& at, SampleSource& source);
/// Density with which that makes the emitter's point `x0`.
double light_tree_pdf(const Scene& scene, const SurfacePoint& at, const SurfacePoint& x0);

/// Draws a point on an emitter, chosen by what it may do at `v`, or as the scene has learned, and scatters its light at
/// `v`. None where that carries nothing. Visibility and media are left to the caller.
std::optional<DirectLight> sample_direct_light(const Scene& scene, const Vertex& v, const Vec3& back,
                                               SampleSource& source);

/// Whether there are so few emitters that each of them can have a sample of its own: which one is chosen is most of the
/// noise of what is seen first.
bool has_few_emitters(const Scene& scene);

/// Draws a point on the emitter as sample_direct_light() does where it has chosen that one. An emitter that would
/// hardly be chosen is left out at random, and weighs more otherwise.
std::optional<DirectLight> sample_light_of(const Scene& scene, std::uint32_t emitter, const Vertex& v, const Vec3& back,
                                           SampleSource& source);

/// Density with which sample_direct_light() draws the emitter point `x0` for `v`, in the coordinates of x0. The chains'
/// own choice goes by power alone: emitter_point_pdf().
double direct_light_pdf(const Scene& scene, const Vertex& v, const SurfacePoint& x0);

/// Radiance that `hit` emits back along `w`, weighted against sample_direct_light() at the finite vertex `v`, whose
/// BSDF drew `w` with density `pdf` per solid angle; `of_each`: against sample_light_of().
Rgb emission_with_mis(const Scene& scene, const Vertex& v, const Vertex& hit, const Vec3& w, double pdf,
                      bool of_each = false);

} // namespace keyhole
