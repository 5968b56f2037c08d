// Direct light at a vertex, visibility included: what comes through clear glass, too.
#pragma once

#include "sampling/paths/clear_glass.h"
#include "sampling/paths/direct_light.h"
#include "sampling/paths/walk.h"

namespace keyhole {

/// Samples of emitters.
struct LightSamples {
    int number;
    int most_faces = kMostFaces; ///< of clear glass that may stand in between
};

/// Direct light that `v` reflects towards `back` [W/(m^2 sr)], by next-event estimation: the mean of stratified samples
/// of emitters, MIS-weighted against a direction of the BSDF, which the caller traces: by sample_emission(), or as a
/// gather ray.
Rgb next_event(const Scene& scene, const Vertex& v, const Vec3& back, const LightSamples& samples,
               SampleSource& source);

/// A direction drawn from a BSDF.
struct DrawnDirection {
    Vec3 w;     ///< unit
    Rgb weight; ///< scattering times cosine over density
    double pdf; ///< per solid angle
};
/// What lies in that direction of emitters: as sample_emission().
template <class Visit>
void visit_emission(const Scene& scene, const Vertex& v, const DrawnDirection& drawn, int most_faces,
                    const Visit& visit) {
    const auto view = look_straight(scene, v.point, drawn.w, most_faces);
    if (!view || !view->end.point.is_emitter()) return;
    visit(view->end.point,
          drawn.weight * view->transmittance * emission_with_mis(scene, v, view->end, drawn.w, drawn.pdf));
}

/// What a direction drawn from the BSDF meets of emitters, weighted against next_event(): `visit(const SurfacePoint&
/// emitter, const Rgb& value)` if it carries anything, through at most `most_faces` of clear glass.
template <class Visit>
void sample_emission(const Scene& scene, const Vertex& v, const Vec3& back, int most_faces, SampleSource& source,
                     const Visit& visit) {
    const auto next = continue_walk(v, back, From::eye, source);
    if (!next || is_specular(next->event)) return;
    visit_emission(scene, v, {next->w, next->weight, next->pdf}, most_faces, visit);
}

/// A direction drawn from one part of a BSDF (Bsdf::glossy_part(), or a diffuse one), weighed two ways.
struct PartContinuation {
    Vec3 w;          ///< unit
    Rgb part;        ///< scattering by the part, times cosine, over the part's density
    Rgb whole;       ///< that by the finite part as a whole, over its density
    double pdf;      ///< density of the whole per solid angle
    double part_pdf; ///< that of the part
};
/// None where the part absorbs. The mean over directions of the whole BSDF is that over its parts, each with the
/// probability with which the whole draws from it (Bsdf::glossy_probability()).
std::optional<PartContinuation> continue_by_part(const Vertex& v, const Bsdf& part, const Vec3& back,
                                                 SampleSource& source);

/// sample_emission() where directions are drawn from the diffuse part alone.
template <class Visit>
void sample_emission_by_diffuse_part(const Scene& scene, const Vertex& v, const Vec3& back, int most_faces,
                                     SampleSource& source, const Visit& visit) {
    const Bsdf white(Frame(v.bsdf.shading_normal()), DiffuseBsdf{Rgb(1.0)});
    if (const auto next = continue_by_part(v, white, back, source))
        visit_emission(scene, v, {next->w, next->whole, next->pdf}, most_faces, visit);
}

/// Direct light that `v` reflects towards `back` [W/(m^2 sr)], by both techniques, weighted against each other: the
/// mean of stratified samples of emitters (next_event()), and one sample of the BSDF (sample_emission()).
Rgb direct_light(const Scene& scene, const Vertex& v, const Vec3& back, const LightSamples& samples,
                 SampleSource& source);

} // namespace keyhole
