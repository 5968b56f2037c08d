#include "sampling/bidirectional_joint.h"

namespace keyhole {

Joint::Joint(const Scene& scene, const TracedSubPath& light, int s, const TracedSubPath& eye, int t, const Vec2& image)
    : scene_(&scene), light_(&light), eye_(&eye), s_(s), t_(t), image_(image) {
    const Vertex& z = vertex(s);
    if (s == 0) {
        possible_ = z.point.is_emitter();
        return;
    }
    // Whatever they did as walks, the two ends of a joint scatter finitely.
    const Vertex& y = vertex(s - 1);
    possible_ = (s == 1 || y.bsdf.traits().finite) && (t == 1 || z.bsdf.traits().finite);
    if (!possible_ || t > 1) return;
    const auto p = scene.camera().image_point(z.point, direction(z.point, y.point));
    possible_ = p.has_value();
    if (p) image_ = *p;
}

const Vertex& Joint::vertex(int i) const {
    return i < s_ ? light_->vertices[static_cast<std::size_t>(i)]
                  : eye_->vertices[static_cast<std::size_t>(s_ + t_ - 1 - i)];
}

LightClass Joint::light_class() const {
    int finite = 0, first = 0;
    for (int i = s_ + t_ - 2; i > 0; --i) {
        if (specular(i)) continue;
        if (++finite == 1) first = i;
        if (finite == 2) return i > 1 ? LightClass::indirect : LightClass::second;
    }
    return first == 0 ? LightClass::emission : first == 1 ? LightClass::direct : LightClass::caustic;
}

int Joint::nth_finite_from_eye(int n) const {
    for (int i = s_ + t_ - 2; i > 0; --i)
        if (!specular(i) && --n == 0) return i;
    return 0;
}

/// What leaves the light sub-path towards the eye's, and the densities that this changes.
Rgb Joint::leave_light(const Vec3& to_eye) {
    const Vertex& y = vertex(s_ - 1);
    const auto end = static_cast<std::size_t>(s_) - 1;
    if (s_ == 1) {
        const Emitter& emitter = scene_->emitter(y.point.emitter);
        from_light_[0] = solid_angle_to_area(emitter.ray_pdf(y.point, to_eye), y.point, vertex(1).point, to_eye);
        return light_->throughput[0] * emitter.radiance(y.point, to_eye);
    }
    const Vertex& before = vertex(s_ - 2);
    const Vec3 back = direction(y.point, before.point);
    const ScatterValue f = scatter(y.point, y.bsdf, Event::finite, back, to_eye);
    from_light_[0] = solid_angle_to_area(f.pdf_to_eye, y.point, vertex(s_).point, to_eye);
    const bool unreachable = s_ == 2 && scene_->emitter(before.point.emitter).is_delta();
    from_eye_[1] = unreachable ? 0.0 : solid_angle_to_area(f.pdf_to_light, y.point, before.point, back);
    return light_->throughput[end] * f.value;
}

/// What the eye asks of light that arrives from the light sub-path, and the densities that this changes.
Rgb Joint::leave_eye(const Vec3& to_light) {
    const Vertex &z = vertex(s_), &y = vertex(s_ - 1);
    const bool unreachable = s_ == 1 && scene_->emitter(y.point.emitter).is_delta();
    if (t_ == 1) {
        const double pdf = scene_->camera().direction_pdf(to_light);
        from_light_[0] = 0; // light never hits the lens by chance
        from_eye_[0] = unreachable ? 0.0 : solid_angle_to_area(pdf, z.point, y.point, to_light);
        return Rgb(pdf);
    }
    const SurfacePoint& next = vertex(s_ + 1).point;
    const Vec3 back = direction(z.point, next);
    const ScatterValue f = scatter(z.point, z.bsdf, Event::finite, to_light, back);
    from_eye_[0] = unreachable ? 0.0 : solid_angle_to_area(f.pdf_to_light, z.point, y.point, to_light);
    from_light_[1] = solid_angle_to_area(f.pdf_to_eye, z.point, next, back);
    return eye_->throughput[static_cast<std::size_t>(t_) - 1] * f.value;
}

Rgb Joint::join() {
    if (s_ > 0) {
        const SurfacePoint &y = vertex(s_ - 1).point, &z = vertex(s_).point;
        const Vec3 to_eye = direction(y, z);
        const Rgb from_light = leave_light(to_eye);
        if (is_black(from_light)) return from_light;
        return from_light * leave_eye(-to_eye) * scene_->transmittance(y, z) * geometry_term(y, z);
    }
    const SurfacePoint &x0 = vertex(0).point, &x1 = vertex(1).point;
    const Emitter& emitter = scene_->emitter(x0.emitter);
    const Vec3 to_eye = direction(x0, x1);
    from_light_[0] = emitter_point_pdf(*scene_, x0);
    from_light_[1] = solid_angle_to_area(emitter.ray_pdf(x0, to_eye), x0, x1, to_eye);
    return eye_->throughput[static_cast<std::size_t>(t_) - 1] * emitter.radiance(x0, to_eye);
}

Rgb Joint::value(MisHeuristic heuristic) {
    const Rgb carried = join();
    return luminance(carried) > 0 ? carried * weight(heuristic) : Rgb(0.0);
}

double Joint::pdf_from_light(int i) const {
    return i == s_ ? from_light_[0] : i == s_ + 1 ? from_light_[1] : vertex(i).pdf_from_light;
}

double Joint::pdf_from_eye(int i) const {
    return i == s_ - 1 ? from_eye_[0] : i == s_ - 2 ? from_eye_[1] : vertex(i).pdf_from_eye;
}

/// Technique k makes x[0], ..., x[k - 1] from the light. Ratios of its density to that of technique s are products of
/// what each vertex changes (Veach 1997, section 10.2).
double Joint::weight(MisHeuristic heuristic) const {
    double sum = 1;
    bool best = true;
    const auto include = [&](int k, double ratio) {
        if (k > 0 && (specular(k - 1) || specular(k))) return;
        sum += heuristic == MisHeuristic::power ? ratio * ratio : ratio;
        best = best && (k < s_ ? ratio < 1 : ratio <= 1); // of equals, the first
    };
    double ratio = 1;
    for (int k = s_ - 1; k >= 0 && ratio > 0; --k) include(k, ratio *= pdf_from_eye(k) / vertex(k).pdf_from_light);
    ratio = 1;
    for (int k = s_ + 1; k < s_ + t_ && ratio > 0; ++k)
        include(k, ratio *= pdf_from_light(k - 1) / vertex(k - 1).pdf_from_eye);
    if (heuristic == MisHeuristic::maximum) return best ? 1 : 0;
    return 1 / sum;
}

bool Joint::visible() const { return s_ == 0 || scene_->visible(vertex(s_ - 1).point, vertex(s_).point); }

Path Joint::path() const {
    Path path;
    for (int i = 0; i < s_ + t_; ++i) path.x.push_back(vertex(i));
    path.x[static_cast<std::size_t>(s_)].event = Event::finite;
    if (s_ > 0) path.x[static_cast<std::size_t>(s_) - 1].event = Event::finite;
    path.image = image_;
    measure(*scene_, path);
    return path;
}

} // namespace keyhole
