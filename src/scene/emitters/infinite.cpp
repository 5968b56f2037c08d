#include "core/error.h"
#include "scene/emitter.h"
#include "scene/emitters/emitters.h"
#include "scene/images/image.h"
#include "scene/load/properties.h"
#include "scene/texture.h"
#include "scene/warp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

/// An emitter whose points are directions: light from infinity, in parallel beams as wide as the scene.
class InfiniteEmitter : public Emitter {
  public:
    Site site() const override { return Site::infinite; }
    bool is_delta() const override { return false; }
    void enclose(const BoundingSphere& scene) override { scene_ = scene; }

    /// A ray along the beam, uniform over its cross-section; it starts outside the scene.
    EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const override {
        const double u0 = source.next(), u1 = source.next();
        const Vec3 w = point.ng;
        const Vec2 d = uniform_disc(u0, u1) * scene_.radius;
        EmitterRay ray;
        ray.origin.site = Site::point;
        ray.origin.p = scene_.center - w * scene_.radius + Frame(w).to_world(Vec3(d.x, d.y, 0));
        ray.w = w;
        ray.pdf = beam_pdf();
        return ray;
    }
    double ray_pdf(const SurfacePoint& /*point*/, const Vec3& /*w*/) const override { return beam_pdf(); }
    const char* kind() const override { return "environment"; }

  protected:
    /// Per area of a beam's cross-section [1/m^2].
    double beam_pdf() const { return kInvPi / (static_cast<double>(scene_.radius) * scene_.radius); }

  private:
    BoundingSphere scene_;
};

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

double radiance_of(float texel) { return texel; }
double radiance_of(std::uint8_t texel) { return srgb_to_linear(texel / 255.0); }
double radiance_of(std::uint16_t texel) { return srgb_to_linear(texel / 65535.0); }

class ImageEnvironment final : public InfiniteEmitter {
  public:
    ImageEnvironment(EnvironmentImage image, const Rgb& scale, const Imath::M33d& to_world)
        : image_(std::move(image)), scale_(scale), to_world_(to_world), from_world_(to_world.inverse()) {
        std::vector<double> weights(image_.radiance.size());
        for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = luminance(pixel(i)) * solid_angle(row_of(i));
        for (const double w : weights) flux_ += w;
        if (!(flux_ > 0)) throw InputError("an environment's picture is black");
        pixels_ = EmitterDistribution(weights);
    }

    double power() const override { return flux_ / beam_pdf(); }

    EmitterPoint sample_point(SampleSource& source) const override {
        const double u0 = source.next(), u1 = source.next(), u2 = source.next();
        const std::size_t i = pixels_.sample(u0);
        const Vec2d place(image_.place_in(i, u1, 0).x, row_place(row_of(i), u2));
        const SurfacePoint point = infinite_point(world_direction(place));
        return {point, point_pdf(point)};
    }
    double point_pdf(const SurfacePoint& point) const override {
        const std::size_t i = pixel_at(-point.ng);
        return pixels_.probability(static_cast<std::uint32_t>(i)) / solid_angle(row_of(i));
    }
    Rgb radiance(const SurfacePoint& /*point*/, const Vec3& w) const override { return pixel(pixel_at(-w)); }

  private:
    std::size_t row_of(std::size_t i) const { return i / static_cast<std::size_t>(image_.width); }
    Rgb pixel(std::size_t i) const { return Rgb(image_.radiance[i]) * scale_; }

    /// Cosine from the zenith at the upper edge of a row of a lat-long picture.
    double edge_cosine(std::size_t row) const { return std::cos(kPi * static_cast<double>(row) / image_.height); }

    /// Of one pixel [sr].
    double solid_angle(std::size_t row) const {
        if (image_.layout == SphereLayout::octahedral)
            return 4 * kPi / (static_cast<double>(image_.width) * image_.height);
        return 2 * kPi / image_.width * (edge_cosine(row) - edge_cosine(row + 1));
    }

    /// Height in the picture that is uniform by solid angle within a row.
    double row_place(std::size_t row, double u) const {
        if (image_.layout == SphereLayout::octahedral) return (static_cast<double>(row) + u) / image_.height;
        const double cosine = edge_cosine(row) + u * (edge_cosine(row + 1) - edge_cosine(row));
        return std::acos(std::clamp(cosine, -1.0, 1.0)) / kPi;
    }

    Vec3 world_direction(const Vec2d& place) const {
        return Vec3(Imath::V3d(sphere_direction(image_.layout, place)) * to_world_).normalized();
    }

    /// Index of the pixel that lies in unit direction `towards`.
    std::size_t pixel_at(const Vec3& towards) const {
        return image_.pixel_at(sphere_place(image_.layout, Vec3(Imath::V3d(towards) * from_world_).normalized()));
    }

    EnvironmentImage image_;
    Rgb scale_;
    Imath::M33d to_world_, from_world_; // for row vectors
    EmitterDistribution pixels_;
    double flux_ = 0; // luminance over the sphere [W/m^2]
};

} // namespace

std::unique_ptr<Emitter> make_constant_environment(const Rgb& radiance) {
    return std::make_unique<ConstantEnvironment>(radiance);
}

std::unique_ptr<Emitter> make_environment_sum(std::vector<std::unique_ptr<Emitter>> environments) {
    return std::make_unique<EnvironmentSum>(std::move(environments));
}

EmitterKinds infinite_kinds() {
    return {{"distant", "a distant emitter", {"direction", "irradiance", "angle"}, read_distant},
            {{"environment", "infinite"},
             "an environment",
             {"radiance", "image", "layout", "transform"},
             [](Properties& p) { return p.is_pbrt() ? read_infinite(p) : read_environment(p); }}};
}

std::unique_ptr<Emitter> make_distant_emitter(const Vec3& w, const Rgb& irradiance, double degrees) {
    // A disc narrower than this is a point to floats.
    constexpr double kLeastDegrees = 0.1;
    if (degrees >= kLeastDegrees) return std::make_unique<SunEmitter>(w, irradiance, degrees);
    return std::make_unique<DistantEmitter>(w, irradiance);
}

EnvironmentImage read_environment_image(const std::string& path, SphereLayout layout) {
    const auto image = load_image(path);
    EnvironmentImage out{image->width, image->height, {}, layout};
    const auto pixels = static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height);
    const auto channels = static_cast<std::size_t>(image->channels);
    out.radiance.resize(pixels);
    std::visit(
        [&](const auto& texels) {
            for (std::size_t i = 0; i < pixels; ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    out.radiance[i][static_cast<int>(k)] =
                        static_cast<float>(radiance_of(texels[i * channels + (channels == 3 ? k : 0)]));
        },
        image->texels);
    const auto impossible = [](const Vec3& c) {
        return !(c.x >= 0 && c.y >= 0 && c.z >= 0 && std::isfinite(c.x + c.y + c.z));
    };
    if (std::ranges::any_of(out.radiance, impossible))
        throw InputError(path + ": found a pixel that is negative or not finite, expected radiance");
    out.file = note_picture({path, out.width, out.height, image->channels, pixels * sizeof(Vec3), image->hash});
    return out;
}

std::unique_ptr<Emitter> make_image_environment(EnvironmentImage image, const Rgb& scale, const Imath::M33d& to_world) {
    const auto size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (size == 0 || image.radiance.size() != size) throw InputError("an environment's picture has no pixels");
    if (image.layout == SphereLayout::octahedral && image.width != image.height)
        throw InputError(
            fmt::format("found an octahedral picture of {} x {} pixels for an environment, expected a square",
                        image.width, image.height));
    if (!is_rotation(to_world)) throw InputError("an environment's transform is more than a rotation");
    return std::make_unique<ImageEnvironment>(std::move(image), scale, to_world);
}

} // namespace keyhole
