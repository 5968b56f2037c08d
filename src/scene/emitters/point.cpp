#include "scene/emitters/emitters.h"

#include "scene/emitters/at_a_point.h"

#include "scene/load/properties.h"
#include "scene/warp.h"

namespace keyhole {
namespace {

class PointEmitter final : public EmitterAtAPoint {
  public:
    PointEmitter(const Vec3& position, const Rgb& intensity) : EmitterAtAPoint(position), intensity_(intensity) {}

    double power() const override { return 4 * kPi * luminance(intensity_); }

    EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const override {
        const double u0 = source.next(), u1 = source.next();
        const Vec3 w = uniform_sphere(u0, u1);
        return {point, w, ray_pdf(point, w)};
    }
    double ray_pdf(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return kInvPi / 4; }

    Rgb radiance(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return intensity_; }
    std::optional<EmitterBounds> bounds() const override {
        return EmitterBounds{.lower = position(), .upper = position(), .intensity = luminance(intensity_)};
    }
    const char* kind() const override { return "point"; }

  private:
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
