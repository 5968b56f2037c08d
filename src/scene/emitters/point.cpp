#include "scene/emitters/emitters.h"

#include "scene/load/properties.h"
#include "scene/warp.h"

namespace keyhole {
namespace {

class PointEmitter final : public Emitter {
  public:
    PointEmitter(const Vec3& position, const Rgb& intensity) : position_(position), intensity_(intensity) {}

    Site site() const override { return Site::point; }
    bool is_delta() const override { return true; }
    double power() const override { return 4 * kPi * luminance(intensity_); }

    EmitterPoint sample_point(SampleSource& /*source*/) const override {
        SurfacePoint point;
        point.p = position_;
        point.site = Site::point;
        return {point, 1.0};
    }
    double point_pdf(const SurfacePoint& /*point*/) const override { return 1; }

    EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const override {
        const double u0 = source.next(), u1 = source.next();
        const Vec3 w = uniform_sphere(u0, u1);
        return {point, w, ray_pdf(point, w)};
    }
    double ray_pdf(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return kInvPi / 4; }

    Rgb radiance(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return intensity_; }
    std::optional<EmitterBounds> bounds() const override {
        return EmitterBounds{.lower = position_, .upper = position_, .intensity = luminance(intensity_)};
    }
    const char* kind() const override { return "point"; }

  private:
    Vec3 position_;
    Rgb intensity_;
};

EmitterPtr read_point(Properties& p) {
    const Vec3 position = p.position({"position", "from"});
    const Rgb intensity = p.light({"intensity", "I"}, "power", 4 * kPi);
    return is_black(intensity) ? nullptr : make_point_emitter(position, intensity);
}

} // namespace

std::unique_ptr<Emitter> make_point_emitter(const Vec3& position, const Rgb& intensity) {
    return std::make_unique<PointEmitter>(position, intensity);
}

EmitterKinds point_kinds() { return {{"point", "a point emitter", {"position", "intensity", "power"}, read_point}}; }

} // namespace keyhole
