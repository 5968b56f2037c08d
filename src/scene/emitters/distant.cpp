#include "scene/emitters/emitters.h"

#include "scene/emitters/beam.h"
#include "scene/load/properties.h"

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

EmitterPtr read_distant(Properties& p) {
    const Vec3 w = p.direction({"direction", ""}, {"", "from"}, {"", "to"});
    const Rgb irradiance = p.light({"irradiance", "L"}, {"", "illuminance"}, 1);
    return is_black(irradiance) ? nullptr : make_distant_emitter(w, irradiance);
}

} // namespace

std::unique_ptr<Emitter> make_distant_emitter(const Vec3& w, const Rgb& irradiance) {
    return std::make_unique<DistantEmitter>(w, irradiance);
}

EmitterKinds distant_kinds() { return {{"distant", "a distant emitter", {"direction", "irradiance"}, read_distant}}; }

} // namespace keyhole
