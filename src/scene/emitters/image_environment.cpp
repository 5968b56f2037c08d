#include "scene/emitters/emitters.h"

#include "core/error.h"
#include "scene/emitters/beam.h"
#include "scene/images/image.h"

#include <algorithm>

namespace keyhole {
namespace {

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
        const Vec2d place((static_cast<double>(column_of(i)) + u1) / image_.width, row_place(row_of(i), u2));
        const SurfacePoint point = infinite_point(world_direction(place));
        return {point, point_pdf(point)};
    }
    double point_pdf(const SurfacePoint& point) const override {
        const std::size_t i = pixel_at(-point.ng);
        return pixels_.probability(static_cast<std::uint32_t>(i)) / solid_angle(row_of(i));
    }
    Rgb radiance(const SurfacePoint& /*point*/, const Vec3& w) const override { return pixel(pixel_at(-w)); }

  private:
    std::size_t width() const { return static_cast<std::size_t>(image_.width); }
    std::size_t row_of(std::size_t i) const { return i / width(); }
    std::size_t column_of(std::size_t i) const { return i % width(); }
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
        const Vec2d place = sphere_place(image_.layout, Vec3(Imath::V3d(towards) * from_world_).normalized());
        const auto cell = [](double x, int n) {
            return static_cast<std::size_t>(std::clamp(static_cast<int>(x * n), 0, n - 1));
        };
        return cell(place.y, image_.height) * width() + cell(place.x, image_.width);
    }

    EnvironmentImage image_;
    Rgb scale_;
    Imath::M33d to_world_, from_world_; // for row vectors
    EmitterDistribution pixels_;
    double flux_ = 0; // luminance over the sphere [W/m^2]
};

} // namespace

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
    return out;
}

std::unique_ptr<Emitter> make_image_environment(EnvironmentImage image, const Rgb& scale, const Imath::M33d& to_world) {
    const auto size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (size == 0 || image.radiance.size() != size) throw InputError("an environment's picture has no pixels");
    if (image.layout == SphereLayout::octahedral && image.width != image.height)
        throw InputError("an environment's octahedral picture is not square");
    if (!is_rotation(to_world)) throw InputError("an environment's transform is more than a rotation");
    return std::make_unique<ImageEnvironment>(std::move(image), scale, to_world);
}

} // namespace keyhole
