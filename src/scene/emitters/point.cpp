#include "core/error.h"
#include "scene/emitters/at_a_point.h"
#include "scene/emitters/emission_profile.h"
#include "scene/emitters/emitters.h"
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

/// The t in [0,1] below which the share u of smoothstep's integral lies: 2 t^3 - t^4 = u, by bisection.
double inverse_smoothstep_integral(double u) {
    double low = 0, high = 1;
    for (int i = 0; i < 40; ++i) {
        const double t = (low + high) / 2;
        (t * t * t * (2 - t) < u ? low : high) = t;
    }
    return (low + high) / 2;
}

/// The same of what a spot's light is between its cones.
double inverse_fade_integral(SpotFade fade, double u) {
    return fade == SpotFade::squared ? std::cbrt(u) : inverse_smoothstep_integral(u);
}

class SpotEmitter final : public EmitterAtAPoint {
  public:
    explicit SpotEmitter(const SpotParameters& p)
        : EmitterAtAPoint(p.position), parameters_(p), frame_(p.axis), cos_full_(std::cos(p.full_degrees * kPi / 180)),
          cos_edge_(std::cos(p.edge_degrees * kPi / 180)) {
        solid_angle_ = spot_solid_angle(p);
        full_share_ = 2 * kPi * (1 - cos_full_) / solid_angle_;
    }

    double power() const override { return luminance(parameters_.intensity) * solid_angle_; }

    EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const override {
        const double u0 = source.next(), u1 = source.next();
        const auto fading = [&](double u) {
            return cos_edge_ + (cos_full_ - cos_edge_) * inverse_fade_integral(parameters_.fade, u);
        };
        const double cosine =
            u0 < full_share_ ? 1 - u0 / full_share_ * (1 - cos_full_) : fading((u0 - full_share_) / (1 - full_share_));
        const Vec3 w = frame_.to_world(spherical(cosine, 2 * kPi * u1)).normalized();
        return {point, w, ray_pdf(point, w)};
    }
    double ray_pdf(const SurfacePoint& /*point*/, const Vec3& w) const override { return falloff(w) / solid_angle_; }

    Rgb radiance(const SurfacePoint& /*point*/, const Vec3& w) const override {
        return parameters_.intensity * falloff(w);
    }
    std::optional<EmitterBounds> bounds() const override {
        const double full = parameters_.full_degrees * kPi / 180, edge = parameters_.edge_degrees * kPi / 180;
        return EmitterBounds{.lower = parameters_.position,
                             .upper = parameters_.position,
                             .axis = parameters_.axis,
                             .spread = full,
                             .reach = edge - full,
                             .intensity = luminance(parameters_.intensity)};
    }
    const char* kind() const override { return "spot"; }

  private:
    double falloff(const Vec3& w) const { return spot_falloff(cosine_to(w), cos_full_, cos_edge_, parameters_.fade); }
    /// Near the axis by the chord: rounding of a float is as much as the cosines of narrow cones differ by.
    double cosine_to(const Vec3& w) const {
        const Imath::V3d axis(parameters_.axis), to(w);
        const double cosine = axis.dot(to);
        return cosine > 0.9 ? 1 - (to - axis).length2() / 2 : cosine;
    }

    SpotParameters parameters_;
    Frame frame_;
    double cos_full_, cos_edge_;
    double solid_angle_ = 0; // of a cone of the same power at full intensity
    double full_share_ = 0;
};

EmitterPtr read_spot(Properties& p) {
    SpotParameters spot;
    spot.position = p.position({"position", "from"});
    spot.axis = p.direction({"direction", ""}, {"position", "from"}, "to");
    spot.edge_degrees = p.number({"angle", "coneangle"}, {"an angle from the axis", 0.001, 180}, 30);
    const NumberRange falloff{"an angle up to 'angle'", 0, spot.edge_degrees};
    spot.full_degrees =
        spot.edge_degrees - p.number({"falloff", "conedeltaangle"}, falloff, std::min(5.0, spot.edge_degrees));
    spot.intensity = p.light({"intensity", "I"}, "power", spot_solid_angle(spot));
    return is_black(spot.intensity) ? nullptr : make_spot_emitter(spot);
}

} // namespace

std::unique_ptr<Emitter> make_point_emitter(const Vec3& position, const Rgb& intensity) {
    return std::make_unique<PointEmitter>(position, intensity);
}

double spot_solid_angle(const SpotParameters& parameters) {
    // The mean of smoothstep is 1/2: half of what lies between the two cones counts. Of squares it is 1/3.
    const double share = parameters.fade == SpotFade::squared ? 1.0 / 3 : 0.5;
    const double full = std::cos(parameters.full_degrees * kPi / 180),
                 edge = std::cos(parameters.edge_degrees * kPi / 180);
    return 2 * kPi * (1 - full + share * (full - edge));
}

std::unique_ptr<Emitter> make_spot_emitter(const SpotParameters& parameters) {
    const bool ordered = parameters.full_degrees >= 0 && parameters.full_degrees <= parameters.edge_degrees &&
                         parameters.edge_degrees > 0 && parameters.edge_degrees <= 180;
    if (!ordered) throw InputError("a spot light needs 0 <= inner angle <= outer angle <= 180 degrees, and some width");
    return std::make_unique<SpotEmitter>(parameters);
}

EmitterKinds point_kinds() {
    return {{"point", "a point emitter", {"position", "intensity", "power"}, read_point},
            {"spot",
             "a spot emitter",
             {"position", "to", "direction", "angle", "falloff", "intensity", "power"},
             read_spot}};
}

} // namespace keyhole
