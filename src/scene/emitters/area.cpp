#include "scene/emitters/emitters.h"

#include "core/error.h"
#include "scene/geometry.h"
#include "scene/load/properties.h"
#include "scene/warp.h"

#include <Imath/ImathBox.h>

#include <cmath>

namespace keyhole {
namespace {

Vec3 normal_of(const TriangleMesh& mesh, std::uint32_t triangle) {
    return triangle_point(mesh, triangle, 1.0f / 3, 1.0f / 3).ng;
}

/// Box of a shape, and the cone of its normals around their mean.
EmitterBounds bounds_of(const TriangleMesh& mesh) {
    Imath::Box3f box;
    Vec3 sum(0, 0, 0);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const auto corner : mesh.triangles[i]) box.extendBy(mesh.positions[corner]);
        sum += normal_of(mesh, i) * static_cast<float>(triangle_area(mesh, i));
    }
    sum.normalize();
    EmitterBounds b;
    b.lower = box.min;
    b.upper = box.max;
    if (sum.length2() == 0) return b; // closed, most likely: everywhere
    float least = 1;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) least = std::min(least, sum.dot(normal_of(mesh, i)));
    b.axis = sum;
    b.spread = std::acos(std::clamp(static_cast<double>(least), -1.0, 1.0));
    return b;
}

EmitterBounds bounds_of(const Sphere& sphere) {
    EmitterBounds b;
    b.lower = sphere.center - Vec3(sphere.radius);
    b.upper = sphere.center + Vec3(sphere.radius);
    return b;
}

class AreaEmitter final : public Emitter {
  public:
    AreaEmitter(const Shape& shape, std::uint32_t index)
        : shape_(shape), index_(index), invisible_(is_invisible_light(shape)),
          parametrised_(reads_parametrisation(shape)), area_(surface_area(shape)) {
        if (!(area_ > 0)) throw InputError("an emitting shape has no area");
        if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
            bounds_ = bounds_of(*sphere);
        } else {
            const auto& mesh = std::get<TriangleMesh>(shape.geometry);
            std::vector<double> areas(mesh.triangles.size());
            for (std::uint32_t i = 0; i < areas.size(); ++i) areas[i] = triangle_area(mesh, i);
            triangles_ = EmitterDistribution(areas);
            bounds_ = bounds_of(mesh);
        }
        luminance_ = mean_luminance();
        bounds_.intensity = luminance_ * area_;
        if (shape.emission->two_sided) bounds_.spread = kPi;
        bounds_.reach = profile().reach();
    }

    Site site() const override { return Site::surface; }
    bool is_delta() const override { return invisible_; }
    double power() const override {
        return luminance_ * area_ * profile().projected_solid_angle() * (shape_.emission->two_sided ? 2 : 1);
    }

    EmitterPoint sample_point(SampleSource& source) const override {
        const auto [u0, u1, u2] = source.take<3>();
        return {place(u0, u1, u2), 1 / area_};
    }
    double point_pdf(const SurfacePoint& /*point*/) const override { return 1 / area_; }

    EmitterRay sample_ray(const SurfacePoint& point, SampleSource& source) const override {
        auto [u0, u1] = source.take<2>();
        bool back = false;
        if (shape_.emission->two_sided) {
            u0 *= 2;
            back = u0 >= 1;
            if (back) u0 -= 1;
        }
        const Vec3 local = cosine_hemisphere(profile().sine2_of_share(u0), u1);
        const Vec3 w = Frame(point.ng).to_world(back ? -local : local);
        return {point, w, ray_pdf(point, w)};
    }
    double ray_pdf(const SurfacePoint& point, const Vec3& w) const override {
        const double c = point.ng.dot(w), size = std::abs(c);
        if (!shape_.emission->two_sided && c <= 0) return 0;
        return size * profile().value(size) /
               (profile().projected_solid_angle() * (shape_.emission->two_sided ? 2 : 1));
    }
    Rgb radiance(const SurfacePoint& point, const Vec3& w) const override {
        const double c = point.ng.dot(w);
        const bool lit = shape_.emission->two_sided || c > 0;
        if (shape_.alpha && !invisible_ && !is_opaque(shape_.alpha, point)) return Rgb(0.0);
        return lit ? emitted(point) * profile().value(std::abs(c)) : Rgb(0.0);
    }
    std::optional<EmitterBounds> bounds() const override { return bounds_; }
    const char* kind() const override { return invisible_ ? "invisible area" : "area"; }

  private:
    const EmissionProfile& profile() const { return shape_.emission->profile; }

    /// Uniform by area.
    SurfacePoint place(double u0, double u1, double u2) const {
        SurfacePoint s;
        if (const auto* sphere = std::get_if<Sphere>(&shape_.geometry)) {
            s = sphere_point(*sphere, uniform_sphere(u1, u2), parametrised_);
        } else {
            const Vec2 b = uniform_triangle(u1, u2);
            s = triangle_point(std::get<TriangleMesh>(shape_.geometry), triangles_.sample(u0), b.x, b.y, parametrised_);
        }
        s.shape = index_;
        s.material = shape_.material.get();
        return s;
    }

    /// Along the normal.
    Rgb emitted(const SurfacePoint& point) const {
        const SurfaceEmission& emission = *shape_.emission;
        return emission.picture == nullptr ? emission.radiance : emission.radiance * emission.picture->value(point);
    }

    /// Over the area, by points of Roberts' sequence. Only probabilities follow from it.
    double mean_luminance() const {
        if (shape_.emission->picture == nullptr) return luminance(shape_.emission->radiance);
        constexpr int kPlaces = 4096;
        constexpr double kStep0 = 0.8191725133961645, kStep1 = 0.6710436067037893, kStep2 = 0.5497004779019703;
        const auto part = [](double x) { return x - std::floor(x); };
        double sum = 0;
        for (int i = 0; i < kPlaces; ++i)
            sum += luminance(emitted(place(part(i * kStep0), part(i * kStep1), part(i * kStep2))));
        return sum / kPlaces;
    }

    const Shape& shape_;
    std::uint32_t index_;
    bool invisible_;
    bool parametrised_;
    double area_;
    double luminance_ = 0; // mean over the area
    EmitterDistribution triangles_;
    EmitterBounds bounds_;
};

/// pbrt's is a file. Null where there is none.
ColorTexture read_picture_of_light(Properties& p) {
    const Key file{"", "filename"};
    if (!p.has(file)) return p.find_color_texture({"texture", ""}, kLight);
    const std::string path = p.path(file, "an image");
    return p.make_at(file, [&] { return image_texture<Rgb>(path, {}); });
}

/// Lambertian where nothing else is said.
EmissionProfile read_profile(Properties& p) {
    const Key spread{"spread", ""}, angle{"angle", ""}, falloff{"falloff", ""};
    if (!p.has(angle)) {
        if (p.has(falloff)) p.fail_at(falloff, "found 'falloff' without 'angle'");
        return EmissionProfile::grid(p.number(spread, {"an angle across the light", 1, 180}, 180));
    }
    if (p.has(spread)) p.fail_at(spread, "found 'spread' beside 'angle', expected one of them");
    const double edge = p.number(angle, {"an angle from the normal", 0.5, 90}, 90);
    const double fades = p.number(falloff, {"an angle up to 'angle'", 0, edge}, std::min(5.0, edge));
    return EmissionProfile::cone(edge - fades, edge);
}

} // namespace

std::unique_ptr<Emitter> make_area_emitter(const Shape& shape, std::uint32_t index) {
    return std::make_unique<AreaEmitter>(shape, index);
}

AreaLight read_area_light(Properties& p) {
    AreaLight light;
    light.profile = read_profile(p);
    light.two_sided = p.boolean({"two_sided", "twosided"}, false);
    light.picture = read_picture_of_light(p);
    light.radiance = p.light({"radiance", "L"}, {"power", ""}, 1);
    // The power is a colour in our files, and a number beside the colour in pbrt's.
    light.power = p.has({"power", ""}) ? 1 : std::max(0.0, p.number({"", "power"}, {}, -1));
    if (light.power > 0 && light.picture != nullptr)
        p.fail_at("power", p.is_pbrt() ? "found 'power' beside 'filename', expected 'scale'"
                                       : "found 'power' beside 'texture', expected 'radiance'");
    return light;
}

std::unique_ptr<SurfaceEmission> emission_of(const AreaLight& light, double area) {
    const int sides = light.two_sided ? 2 : 1;
    const double per_radiance = light.profile.projected_solid_angle() * area * sides;
    const Rgb radiance = light.power > 0 ? light.radiance * (light.power / per_radiance) : light.radiance;
    if (is_black(radiance)) return nullptr;
    return std::make_unique<SurfaceEmission>(SurfaceEmission{radiance, light.two_sided, light.picture, light.profile});
}

} // namespace keyhole
