#include "scene/emitters/emitters.h"

#include "scene/emitters/beam.h"
#include "scene/load/properties.h"
#include "scene/warp.h"

#include <cmath>

namespace keyhole {
namespace {

class DistantEmitter final : public InfiniteEmitter {
  public:
    DistantEmitter(const Vec3& w, const Rgb& irradiance) : point_(infinite_point(-w)), irradiance_(irradiance) {}

    bool is_delta() const override { return true; }
    double power() const override { return luminance(irradiance_) / beam_pdf(); }
    EmitterPoint sample_point(SampleSource& /*source*/) const override { return {point_, 1.0}; }
    double point_pdf(const SurfacePoint& /*point*/) const override { return 1; }
    Rgb radiance(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return irradiance_; }
    const char* kind() const override { return "distant"; }

  private:
    SurfacePoint point_;
    Rgb irradiance_;
};

/// A disc of directions, each as bright as the other.
class SunEmitter final : public InfiniteEmitter {
  public:
    SunEmitter(const Vec3& w, const Rgb& irradiance, double degrees)
        : frame_(-w), irradiance_(irradiance), cos_edge_(std::cos(degrees * kPi / 360)),
          sin2_edge_(std::pow(std::sin(degrees * kPi / 360), 2)),
          solid_angle_(4 * kPi * std::pow(std::sin(degrees * kPi / 720), 2)) {}

    double power() const override { return luminance(irradiance_) / beam_pdf(); }
    EmitterPoint sample_point(SampleSource& source) const override {
        const double u0 = source.next(), u1 = source.next();
        const Vec3 local = uniform_cone(u0, u1, cos_edge_);
        return {infinite_point(frame_.to_world(local).normalized()), 1 / solid_angle_};
    }
    double point_pdf(const SurfacePoint& point) const override { return contains(point) ? 1 / solid_angle_ : 0.0; }
    Rgb radiance(const SurfacePoint& point, const Vec3& /*w*/) const override {
        return contains(point) ? irradiance_ / (kPi * sin2_edge_) : Rgb(0.0);
    }

  private:
    /// By the sine, which floats resolve where the cosine is nearly 1; what is drawn at the edge must not fall out.
    bool contains(const SurfacePoint& point) const {
        constexpr double kRounding = 1 + 1e-3;
        return point.p.dot(frame_.n) > 0 && point.p.cross(frame_.n).length2() <= sin2_edge_ * kRounding;
    }

    Frame frame_; // its normal points at the middle of the disc
    Rgb irradiance_;
    double cos_edge_, sin2_edge_, solid_angle_;
};

EmitterPtr read_distant(Properties& p) {
    const Vec3 w = p.direction({"direction", ""}, {"", "from"}, {"", "to"});
    const Rgb irradiance = p.light({"irradiance", "L"}, {"", "illuminance"}, 1);
    const double angle = p.number({"angle", ""}, {"an angle in degrees", 0, 90}, 0);
    return is_black(irradiance) ? nullptr : make_distant_emitter(w, irradiance, angle);
}

} // namespace

std::unique_ptr<Emitter> make_distant_emitter(const Vec3& w, const Rgb& irradiance, double degrees) {
    // A disc narrower than this is a point to floats.
    constexpr double kLeastDegrees = 0.1;
    if (degrees >= kLeastDegrees) return std::make_unique<SunEmitter>(w, irradiance, degrees);
    return std::make_unique<DistantEmitter>(w, irradiance);
}

EmitterKinds distant_kinds() {
    return {{"distant", "a distant emitter", {"direction", "irradiance", "angle"}, read_distant}};
}

} // namespace keyhole
