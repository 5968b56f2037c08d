// Light from one point whose intensity is a picture of directions: luminaires as measured, and projectors.
#include "core/error.h"
#include "scene/emitters/emitters.h"

#include "scene/emitters/at_a_point.h"
#include "scene/load/properties.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

/// All directions.
struct SphereView {
    SphereLayout layout;

    Vec3 direction(const Vec2d& place) const { return sphere_direction(layout, place); }
    std::optional<Vec2d> place(const Vec3& w) const { return sphere_place(layout, w); }
    /// Of the picture's unit square [sr].
    double solid_angle(const Vec3& w) const {
        if (layout == SphereLayout::octahedral) return 4 * kPi;
        return 2 * kPi * kPi * std::sqrt(std::max(0.0, 1 - static_cast<double>(w.y) * w.y));
    }
};

/// A window at distance 1 along +z; the first row is up, +y, and +x is to the right.
struct ProjectedView {
    double half_x, half_y;

    Vec3 direction(const Vec2d& place) const {
        return Vec3(Imath::V3d((2 * place.x - 1) * half_x, (1 - 2 * place.y) * half_y, 1).normalized());
    }
    std::optional<Vec2d> place(const Vec3& w) const {
        if (!(w.z > 0)) return std::nullopt;
        const Vec2d p(0.5 + 0.5 * w.x / (w.z * half_x), 0.5 - 0.5 * w.y / (w.z * half_y));
        // Directions are floats: one that was drawn at the border must not lie beyond it.
        const double rounding = 1e-6 * (1 + 1 / std::min(half_x, half_y));
        const auto within = [&](double x) { return x > -rounding && x < 1 + rounding; };
        if (!within(p.x) || !within(p.y)) return std::nullopt;
        return p;
    }
    double solid_angle(const Vec3& w) const {
        const double cosine = w.z;
        return 4 * half_x * half_y * cosine * cosine * cosine;
    }
};

ProjectedView projected_view(double fov_degrees, int width, int height) {
    const double half = std::tan(fov_degrees * kPi / 360), shorter = std::min(width, height);
    return {half * width / shorter, half * height / shorter};
}

template <class View> class PictureEmitter final : public EmitterAtAPoint {
  public:
    PictureEmitter(EnvironmentImage image, View view, const PictureFrame& frame, const Rgb& scale)
        : EmitterAtAPoint(frame.position), image_(std::move(image)), view_(view), to_world_(frame.to_world),
          from_world_(frame.to_world.inverse()), scale_(scale) {
        if (!is_rotation(frame.to_world)) throw InputError("a light's transform is more than a rotation");
        if (image_.layout == SphereLayout::octahedral && image_.width != image_.height)
            throw InputError(fmt::format("found an octahedral picture of {} x {} pixels for a light, expected a square",
                                         image_.width, image_.height));
        std::vector<double> weights(image_.radiance.size());
        for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = luminance(pixel(i)) * pixel_solid_angle(i);
        for (const double w : weights) power_ += w;
        if (!(power_ > 0)) throw InputError("a light's picture is black");
        pixels_ = EmitterDistribution(weights);
        const auto brightest =
            std::ranges::max_element(image_.radiance, {}, [](const Vec3& c) { return luminance(Rgb(c)); });
        most_ = luminance(Rgb(*brightest) * scale_);
    }

    double power() const override { return power_; }

    EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const override {
        const double u0 = source.next(), u1 = source.next(), u2 = source.next();
        const Vec2d place = image_.place_in(pixels_.sample(u0), u1, u2);
        const Vec3 w = Vec3(Imath::V3d(view_.direction(place)) * to_world_).normalized();
        return {point, w, ray_pdf(point, w)};
    }
    double ray_pdf(const SurfacePoint& /*point*/, const Vec3& w) const override {
        const Vec3 local = from_world(w);
        const auto i = pixel_at(local);
        const double solid_angle = view_.solid_angle(local);
        if (!i || !(solid_angle > 0)) return 0;
        return pixels_.probability(static_cast<std::uint32_t>(*i)) * static_cast<double>(image_.radiance.size()) /
               solid_angle;
    }
    Rgb radiance(const SurfacePoint& /*point*/, const Vec3& w) const override {
        const auto i = pixel_at(from_world(w));
        return i ? pixel(*i) : Rgb(0.0);
    }
    std::optional<EmitterBounds> bounds() const override {
        return EmitterBounds{.lower = position(), .upper = position(), .intensity = most_};
    }
    const char* kind() const override { return "picture"; }

  private:
    Rgb pixel(std::size_t i) const { return Rgb(image_.radiance[i]) * scale_; }
    Vec3 from_world(const Vec3& w) const { return Vec3(Imath::V3d(w) * from_world_).normalized(); }

    std::optional<std::size_t> pixel_at(const Vec3& local) const {
        const std::optional<Vec2d> place = view_.place(local);
        return place ? std::optional(image_.pixel_at(*place)) : std::nullopt;
    }

    /// [sr], by the midpoints of a grid, which is finer in small pictures.
    double pixel_solid_angle(std::size_t i) const {
        const int steps = image_.radiance.size() < 65536 ? 8 : 1;
        double sum = 0;
        for (int k = 0; k < steps * steps; ++k) {
            const double x = (k % steps + 0.5) / steps, y = (k / steps + 0.5) / steps; // NOLINT: rows of the grid
            sum += view_.solid_angle(view_.direction(image_.place_in(i, x, y)));
        }
        return sum / (steps * steps) / static_cast<double>(image_.radiance.size());
    }

    EnvironmentImage image_;
    View view_;
    Imath::M33d to_world_, from_world_; // for row vectors
    Rgb scale_;
    EmitterDistribution pixels_;
    double power_ = 0, most_ = 0; // luminous, and the most intensity
};

/// Luminous power [W] of a picture times 1.
template <class View> double power_of(const EnvironmentImage& image, View view, const PictureFrame& frame) {
    return PictureEmitter<View>(image, view, frame, Rgb(1.0)).power();
}

/// What both formats say alike: where it stands, which way it looks, how bright it is.
template <class View, class MakeView> EmitterPtr read_picture_light(Properties& p, SphereLayout layout, MakeView make) {
    const Key file{"image", "filename"};
    const std::string path = p.path(file, "a picture");
    PictureFrame frame;
    frame.position = p.is_pbrt() ? p.position({"position", "from"}) : p.position("position");
    frame.to_world = p.rotation("transform");
    const auto made = [&]() -> EmitterPtr {
        EnvironmentImage image = read_environment_image(path, layout);
        const View view = make(image);
        if (p.is_pbrt() && std::is_same_v<View, SphereView>) { // its y and z are exchanged, and it has no colour
            const Imath::M33d swap(1, 0, 0, 0, 0, 1, 0, 1, 0);
            frame.to_world = swap * frame.to_world;
            for (Vec3& c : image.radiance) c = Vec3((c.x + c.y + c.z) / 3);
        }
        const Rgb scale = p.light({"intensity", "I"}, "power", power_of(image, view, frame));
        if (is_black(scale)) return nullptr;
        return std::make_unique<PictureEmitter<View>>(std::move(image), view, frame, scale);
    };
    return p.make_at(file, made);
}

EmitterPtr read_goniometric(Properties& p) {
    const bool lat_long = !p.is_pbrt() && p.choice("layout", "a layout", {"lat_long", "octahedral"}) == "lat_long";
    const auto layout = lat_long ? SphereLayout::lat_long : SphereLayout::octahedral;
    return read_picture_light<SphereView>(p, layout,
                                          [&](const EnvironmentImage& /*image*/) { return SphereView{layout}; });
}

EmitterPtr read_projection(Properties& p) {
    const double fov = p.number("fov", {"a field of view in degrees", 0.001, 179}, 90);
    return read_picture_light<ProjectedView>(p, SphereLayout::lat_long, [&](const EnvironmentImage& image) {
        return projected_view(fov, image.width, image.height);
    });
}

} // namespace

std::unique_ptr<Emitter> make_goniometric_emitter(EnvironmentImage image, const PictureFrame& frame, const Rgb& scale) {
    const SphereView view{image.layout};
    return std::make_unique<PictureEmitter<SphereView>>(std::move(image), view, frame, scale);
}

std::unique_ptr<Emitter> make_projection_emitter(EnvironmentImage image, double fov_degrees, const PictureFrame& frame,
                                                 const Rgb& scale) {
    const ProjectedView view = projected_view(fov_degrees, image.width, image.height);
    return std::make_unique<PictureEmitter<ProjectedView>>(std::move(image), view, frame, scale);
}

EmitterKinds picture_kinds() {
    return {{"goniometric",
             "a goniometric emitter",
             {"position", "image", "layout", "transform", "intensity", "power"},
             read_goniometric},
            {"projection",
             "a projector",
             {"position", "image", "fov", "transform", "intensity", "power"},
             read_projection}};
}

} // namespace keyhole
