#include "scene/emitters/distant.h"

#include "scene/emitters/beam.h"

namespace keyhole {
namespace {

class DistantEmitter final : public Emitter {
  public:
    DistantEmitter(const Vec3& w, const Rgb& irradiance) : point_(infinite_point(-w)), irradiance_(irradiance) {}

    Site site() const override { return Site::infinite; }
    bool is_delta() const override { return true; }
    void enclose(const BoundingSphere& scene) override { scene_ = scene; }

    double power() const override { return luminance(irradiance_) / beam_pdf(scene_); }
    EmitterPoint sample_point(SampleSource& /*source*/) const override { return {point_, 1.0}; }
    double point_pdf(const SurfacePoint& /*point*/) const override { return 1; }
    EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const override {
        return sample_beam(scene_, point.ng, source);
    }
    double ray_pdf(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return beam_pdf(scene_); }
    Rgb radiance(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return irradiance_; }
    const char* kind() const override { return "distant"; }

  private:
    SurfacePoint point_;
    Rgb irradiance_;
    BoundingSphere scene_;
};

} // namespace

std::unique_ptr<Emitter> make_distant_emitter(const Vec3& w, const Rgb& irradiance) {
    return std::make_unique<DistantEmitter>(w, irradiance);
}

} // namespace keyhole
