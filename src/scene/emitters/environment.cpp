#include "scene/emitters/environment.h"

#include "scene/emitters/beam.h"

namespace keyhole {
namespace {

class ConstantEnvironment final : public Emitter {
  public:
    explicit ConstantEnvironment(const Rgb& radiance) : radiance_(radiance) {}

    Site site() const override { return Site::infinite; }
    bool is_delta() const override { return false; }
    void enclose(const BoundingSphere& scene) override { scene_ = scene; }

    double power() const override { return luminance(radiance_) * 4 * kPi / beam_pdf(scene_); }
    EmitterPoint sample_point(SampleSource& source) const override {
        const double u0 = source.next(), u1 = source.next();
        return {infinite_point(uniform_sphere(u0, u1)), kInvPi / 4};
    }
    double point_pdf(const SurfacePoint& /*point*/) const override { return kInvPi / 4; }
    EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const override {
        return sample_beam(scene_, point.ng, source);
    }
    double ray_pdf(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return beam_pdf(scene_); }
    Rgb radiance(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return radiance_; }
    const char* kind() const override { return "environment"; }

  private:
    Rgb radiance_;
    BoundingSphere scene_;
};

class EnvironmentSum final : public Emitter {
  public:
    explicit EnvironmentSum(std::vector<std::unique_ptr<Emitter>> parts) : parts_(std::move(parts)) {}

    Site site() const override { return Site::infinite; }
    bool is_delta() const override { return false; }
    void enclose(const BoundingSphere& scene) override {
        scene_ = scene;
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
    EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const override {
        return sample_beam(scene_, point.ng, source);
    }
    double ray_pdf(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return beam_pdf(scene_); }
    Rgb radiance(const SurfacePoint& point, const Vec3& w) const override {
        Rgb sum(0.0);
        for (const auto& part : parts_) sum += part->radiance(point, w);
        return sum;
    }
    const char* kind() const override { return "environment"; }

  private:
    std::vector<std::unique_ptr<Emitter>> parts_;
    EmitterDistribution choice_;
    BoundingSphere scene_;
};

} // namespace

std::unique_ptr<Emitter> make_constant_environment(const Rgb& radiance) {
    return std::make_unique<ConstantEnvironment>(radiance);
}

std::unique_ptr<Emitter> make_environment_sum(std::vector<std::unique_ptr<Emitter>> environments) {
    return std::make_unique<EnvironmentSum>(std::move(environments));
}

} // namespace keyhole
