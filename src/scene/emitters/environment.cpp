#include "scene/emitters/emitters.h"

#include "core/error.h"
#include "scene/emitters/beam.h"
#include "scene/load/properties.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

class ConstantEnvironment final : public InfiniteEmitter {
  public:
    explicit ConstantEnvironment(const Rgb& radiance) : radiance_(radiance) {}

    double power() const override { return luminance(radiance_) * 4 * kPi / beam_pdf(); }
    EmitterPoint sample_point(SampleSource& source) const override {
        const double u0 = source.next(), u1 = source.next();
        return {infinite_point(uniform_sphere(u0, u1)), kInvPi / 4};
    }
    double point_pdf(const SurfacePoint& /*point*/) const override { return kInvPi / 4; }
    Rgb radiance(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return radiance_; }

  private:
    Rgb radiance_;
};

class EnvironmentSum final : public InfiniteEmitter {
  public:
    explicit EnvironmentSum(std::vector<std::unique_ptr<Emitter>> parts) : parts_(std::move(parts)) {}

    void enclose(const BoundingSphere& scene) override {
        InfiniteEmitter::enclose(scene);
        std::vector<double> powers;
        for (const auto& part : parts_) {
            part->enclose(scene);
            powers.push_back(part->power());
        }
        choice_ = EmitterDistribution(powers);
    }

    double power() const override {
        double sum = 0;
        for (const auto& part : parts_) sum += part->power();
        return sum;
    }
    EmitterPoint sample_point(SampleSource& source) const override {
        const std::uint32_t i = choice_.sample(source.next());
        const SurfacePoint point = parts_[i]->sample_point(source).point;
        return {point, point_pdf(point)};
    }
    double point_pdf(const SurfacePoint& point) const override {
        double sum = 0;
        for (std::uint32_t i = 0; i < parts_.size(); ++i) sum += choice_.probability(i) * parts_[i]->point_pdf(point);
        return sum;
    }
    Rgb radiance(const SurfacePoint& point, const Vec3& w) const override {
        Rgb sum(0.0);
        for (const auto& part : parts_) sum += part->radiance(point, w);
        return sum;
    }

  private:
    std::vector<std::unique_ptr<Emitter>> parts_;
    EmitterDistribution choice_;
};

EmitterPtr read_picture(Properties& p, Key file, SphereLayout layout, const Rgb& radiance) {
    const std::string path = p.path(file, "a picture");
    const Imath::M33d to_world = p.rotation("transform");
    return p.make_at(file,
                     [&] { return make_image_environment(read_environment_image(path, layout), radiance, to_world); });
}

EmitterPtr read_environment(Properties& p) {
    const bool image = p.has("image");
    for (const char* key : {"layout", "transform"})
        if (!image && p.has(key)) p.fail(fmt::format("found '{}' without 'image', expected both or neither", key));
    const Rgb radiance = p.color("radiance", ColorUse::light, kLight, Rgb(1.0));
    const bool octahedral = p.choice("layout", "a layout", {"lat_long", "octahedral"}) == "octahedral";
    if (is_black(radiance)) return nullptr;
    if (!image) return make_constant_environment(radiance);
    return read_picture(p, "image", octahedral ? SphereLayout::octahedral : SphereLayout::lat_long, radiance);
}

/// pbrt's pictures are octahedral and lie in the space of the light; v3's are refused.
EmitterPtr read_infinite(Properties& p) {
    if (p.has("mapname"))
        p.fail("found 'mapname', a picture by longitude and latitude as of pbrt-v3, expected 'filename' and a picture "
               "in pbrt-v4's equal-area octahedral map (imgtool makeequiarea makes one)");
    if (p.has("portal")) p.warn("portal", "the portal is ignored: the light comes from everywhere");
    const bool image = p.has("filename");
    if (image && p.has("L")) p.fail("found both 'L' and 'filename', expected one of them");
    if (image && p.number("illuminance", {}, -1) > 0) p.fail("found 'illuminance' of a picture, expected 'scale'");
    const Rgb radiance = p.light("L", "illuminance", kPi);
    if (is_black(radiance)) return nullptr;
    if (!image) return make_constant_environment(radiance);
    return read_picture(p, "filename", SphereLayout::octahedral, radiance);
}

} // namespace

std::unique_ptr<Emitter> make_constant_environment(const Rgb& radiance) {
    return std::make_unique<ConstantEnvironment>(radiance);
}

std::unique_ptr<Emitter> make_environment_sum(std::vector<std::unique_ptr<Emitter>> environments) {
    return std::make_unique<EnvironmentSum>(std::move(environments));
}

EmitterKinds environment_kinds() {
    return {{{"environment", "infinite"},
             "an environment",
             {"radiance", "image", "layout", "transform"},
             [](Properties& p) { return p.is_pbrt() ? read_infinite(p) : read_environment(p); }}};
}

} // namespace keyhole
