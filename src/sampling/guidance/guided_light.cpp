#include "sampling/guidance/guided_light.h"

namespace keyhole {
namespace {

/// Room for the walk's vertices, one for each thread: to make such a thing anew costs as much as to trace a ray.
Path& scratch() {
    thread_local Path path;
    path.x.clear();
    return path;
}

} // namespace

GuidedLightWalk::GuidedLightWalk(const Scene& scene, const LightPathSampling& sampling)
    : scene_(&scene), sampling_(sampling), path_(&scratch()), density_(sampling.guided() ? 1 - kGuided : 1) {}

bool GuidedLightWalk::emit(const SurfacePoint& x0, const Vec3& w) {
    path_->x.push_back(make_vertex(x0));
    Vertex& v = path_->x.back();
    v.event = Event::finite;
    past_.from_infinity = v.point.site == Site::infinite;
    const Emitter& emitter = scene_->emitter(v.point.emitter);
    v.pdf_from_light = product_ = emitter_point_pdf(*scene_, v.point);
    next_pdf_ = emitter.ray_pdf(v.point, w);
    if (!(product_ > 0 && next_pdf_ > 0)) return false;
    power_ = emitter.radiance(v.point, w) * (v.point.abs_cos(w) / (product_ * next_pdf_));
    reference_ = luminance(power());
    return reference_ > 0;
}

void GuidedLightWalk::arrive(const Vertex& v) {
    const SurfacePoint& from = last().point;
    if (sampling_.learned != nullptr && vertices() == 1) {
        density_ *= sampling_.learned->density_ratio(from, direction(from, v.point), v.point.p);
        reference_ = luminance(power());
    }
    path_->x.push_back(v);
    Vertex& here = path_->x.back();
    here.event = Event::finite;
    here.pdf_from_light = solid_angle_to_area(next_pdf_, from, here.point);
    product_ *= here.pdf_from_light;
    power_ *= scene_->transmittance(from, here.point);
    past_.density = density_;
    if (!sampling_.guided() || !(product_ > 0) || !here.bsdf.traits().finite) return;
    double guided = 0;
    sampling_.user_paths->for_each([&](const GuidedSubPath& guide, double probability) {
        if (guide.vertices() == vertices()) guided += probability * guide.density(*path_) / product_;
    });
    if (!(guided > 0)) return;
    past_.density = density_ += kGuided * guided;
    reference_ = luminance(power());
    guided_ = true;
}

double GuidedLightWalk::leave(Event event, const Vec3& w) {
    const SurfacePoint& from = last().point;
    const ScatterValue s = scatter(from, last().bsdf, event, to_light(), w);
    return s.pdf_to_eye > 0 ? leave(event, s.value * (from.abs_cos(w) / s.pdf_to_eye), s.pdf_to_eye) : 0.0;
}

double GuidedLightWalk::leave(Event event, const Rgb& weight, double pdf) {
    Vertex& v = path_->x.back();
    v.event = event;
    next_pdf_ = pdf;
    power_ *= weight;
    past_.meet(v, to_light());
    const double survive = photon_survival(power(), reference_);
    if (survive > 0) density_ *= survive;
    return survive;
}

} // namespace keyhole
