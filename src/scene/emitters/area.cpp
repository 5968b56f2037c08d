#include "scene/emitters/emitters.h"

#include "core/error.h"
#include "scene/geometry.h"
#include "scene/load/properties.h"
#include "scene/warp.h"

namespace keyhole {
namespace {

Vec3 normal_of(const TriangleMesh& mesh, std::uint32_t triangle) {
    return triangle_point(mesh, triangle, 1.0f / 3, 1.0f / 3).ng;
}

/// Box of a shape, and the cone of its normals around their mean.
EmitterBounds bounds_of(const TriangleMesh& mesh) {
    EmitterBounds b;
    b.lower = b.upper = mesh.positions[mesh.triangles[0][0]];
    Vec3 sum(0, 0, 0);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const auto corner : mesh.triangles[i])
            for (int k = 0; k < 3; ++k) {
                b.lower[k] = std::min(b.lower[k], mesh.positions[corner][k]);
                b.upper[k] = std::max(b.upper[k], mesh.positions[corner][k]);
            }
        sum += normal_of(mesh, i) * static_cast<float>(triangle_area(mesh, i));
    }
    sum.normalize();
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
        if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) {
            std::vector<double> areas(mesh->triangles.size());
            for (std::uint32_t i = 0; i < areas.size(); ++i) areas[i] = triangle_area(*mesh, i);
            triangles_ = EmitterDistribution(areas);
        }
        bounds_ = std::visit([](const auto& geometry) { return bounds_of(geometry); }, shape.geometry);
        bounds_.intensity = luminance(shape.emission->radiance) * area_;
        if (shape.emission->two_sided) bounds_.spread = kPi;
    }

    Site site() const override { return Site::surface; }
    bool is_delta() const override { return invisible_; }
    double power() const override {
        return luminance(shape_.emission->radiance) * area_ * kPi * (shape_.emission->two_sided ? 2 : 1);
    }

    EmitterPoint sample_point(SampleSource& source) const override {
        const auto [u0, u1, u2] = source.take<3>();
        SurfacePoint s;
        if (const auto* sphere = std::get_if<Sphere>(&shape_.geometry)) {
            s = sphere_point(*sphere, uniform_sphere(u1, u2), parametrised_);
        } else {
            const Vec2 b = uniform_triangle(u1, u2);
            s = triangle_point(std::get<TriangleMesh>(shape_.geometry), triangles_.sample(u0), b.x, b.y, parametrised_);
        }
        s.shape = index_;
        s.material = shape_.material.get();
        return {s, 1 / area_};
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
        const Vec3 local = cosine_hemisphere(u0, u1);
        const Vec3 w = Frame(point.ng).to_world(back ? -local : local);
        return {point, w, ray_pdf(point, w)};
    }
    double ray_pdf(const SurfacePoint& point, const Vec3& w) const override {
        const double c = point.ng.dot(w);
        if (shape_.emission->two_sided) return std::abs(c) * kInvPi / 2;
        return c > 0 ? c * kInvPi : 0.0;
    }
    Rgb radiance(const SurfacePoint& point, const Vec3& w) const override {
        const bool lit = shape_.emission->two_sided || point.ng.dot(w) > 0;
        if (shape_.alpha && !invisible_ && !is_opaque(shape_.alpha, point)) return Rgb(0.0);
        return lit ? shape_.emission->radiance : Rgb(0.0);
    }
    std::optional<EmitterBounds> bounds() const override { return bounds_; }
    const char* kind() const override { return invisible_ ? "invisible area" : "area"; }

  private:
    const Shape& shape_;
    std::uint32_t index_;
    bool invisible_;
    bool parametrised_;
    double area_;
    EmitterDistribution triangles_;
    EmitterBounds bounds_;
};

} // namespace

std::unique_ptr<Emitter> make_area_emitter(const Shape& shape, std::uint32_t index) {
    return std::make_unique<AreaEmitter>(shape, index);
}

AreaLight read_area_light(Properties& p) {
    AreaLight light;
    light.two_sided = p.boolean({"two_sided", "twosided"}, false);
    if (p.has({"", "filename"})) p.fail("found 'filename', expected emission that is the same everywhere");
    light.radiance = p.light({"radiance", "L"}, {"power", ""}, 1);
    // The power is a colour in our files, and a number beside the colour in pbrt's.
    light.power = p.has({"power", ""}) ? 1 : std::max(0.0, p.number({"", "power"}, {}, -1));
    return light;
}

std::unique_ptr<SurfaceEmission> emission_of(const AreaLight& light, double area) {
    const int sides = light.two_sided ? 2 : 1;
    // A Lambertian emitter of radiance L sends out pi L from each unit of area of each side.
    const Rgb radiance = light.power > 0 ? light.radiance * light.power / (kPi * area * sides) : light.radiance;
    if (is_black(radiance)) return nullptr;
    return std::make_unique<SurfaceEmission>(SurfaceEmission{radiance, light.two_sided});
}

} // namespace keyhole
