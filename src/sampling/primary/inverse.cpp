#include "sampling/primary/inverse.h"

#include "scene/bsdfs/fresnel.h"
#include "scene/geometry.h"

#include <cmath>
#include <cstring>

namespace keyhole {
namespace {

constexpr double kBelowOne = 1 - 0x1p-53;

double turn(double y, double x) { // as a share of a full turn, in [0,1)
    const double t = std::atan2(y, x) / (2 * kPi);
    return std::min(t < 0 ? t + 1 : t, kBelowOne);
}

double between(double low, double high, SampleSource& rng) {
    return std::min(low + (high - low) * rng.next(), kBelowOne);
}

/// Inverse of cosine_hemisphere().
std::array<double, 2> invert_hemisphere(const Vec3& w) {
    const double z = w.z;
    return {std::clamp(1 - z * z, 0.0, kBelowOne), turn(w.y, w.x)};
}

/// Inverse of Ggx::sample_visible().
std::array<double, 2> invert_visible(const Ggx& ggx, const LocalVec& w, const LocalVec& h) {
    const LocalVec v = LocalVec(ggx.alpha_x * w.x, ggx.alpha_y * w.y, w.z).normalized();
    const LocalVec n = LocalVec(h.x / ggx.alpha_x, h.y / ggx.alpha_y, h.z).normalized();
    const double length = std::hypot(v.x, v.y);
    const LocalVec t1 = length > 0 ? LocalVec(-v.y / length, v.x / length, 0) : LocalVec(1, 0, 0);
    const LocalVec t2 = v.cross(t1);
    const double p1 = n.dot(t1), s = (1 + v.z) / 2;
    const double p2 = (n.dot(t2) - (1 - s) * std::sqrt(std::max(0.0, 1 - p1 * p1))) / s;
    return {std::clamp(p1 * p1 + p2 * p2, 0.0, kBelowOne), turn(p2, p1)};
}

using Numbers = std::optional<std::array<double, 3>>;

/// One overload for each model that has an inverse. Directions are local.
struct Inverter {
    Vec3 back, to;
    Event event;
    SampleSource& rng;

    Numbers anything() const { return {{rng.next(), rng.next(), rng.next()}}; }

    Numbers operator()(const DiffuseBsdf&) const {
        const auto [u0, u1] = invert_hemisphere({to.x, to.y, std::abs(to.z)});
        return {{u0, u1, rng.next()}};
    }
    Numbers operator()(const MirrorBsdf&) const { return anything(); }
    Numbers operator()(const ConductorBsdf&) const { return anything(); }
    Numbers operator()(const RoughConductorBsdf& m) const {
        const LocalVec w = upper(back);
        const auto [u0, u1] = invert_visible({m.alpha_x, m.alpha_y}, w, half_vector(w, upper(to)));
        return {{u0, u1, rng.next()}};
    }
    Numbers operator()(const GlassBsdf& m) const {
        const double r = fresnel_dielectric(std::abs(back.z), back.z > 0 ? m.eta : 1 / m.eta).reflectance;
        const double u2 = event == Event::reflect ? between(0, r, rng) : between(r, 1, rng);
        return {{rng.next(), rng.next(), u2}};
    }
    template <class Model> Numbers operator()(const Model&) const { return std::nullopt; }
};

} // namespace

std::optional<std::array<double, 3>> invert_bsdf(const Vertex& v, const Vec3& back, const Vec3& to, SampleSource& rng) {
    const Frame frame = v.point.shading_frame();
    if (frame.n != v.bsdf.shading_normal()) return std::nullopt; // bumped: the frame is not the point's
    return std::visit(Inverter{frame.to_local(back), frame.to_local(to), v.event, rng}, v.bsdf.model());
}

EmitterInverse::EmitterInverse(const Scene& scene) : scene_(&scene), triangles_(scene.shapes().size()) {
    choice_.push_back(0);
    for (std::uint32_t i = 0; i < scene.emitters().size(); ++i)
        choice_.push_back(choice_.back() + scene.emitter_distribution().probability(i));
    for (std::size_t i = 0; i < scene.shapes().size(); ++i) {
        const Shape& shape = scene.shapes()[i];
        const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
        if (mesh == nullptr || !shape.emission || shape.emission->two_sided) continue;
        std::vector<double> areas(mesh->triangles.size());
        for (std::uint32_t k = 0; k < areas.size(); ++k) areas[k] = triangle_area(*mesh, k);
        triangles_[i] = EmitterDistribution(areas);
    }
}

std::optional<std::array<double, 4>> EmitterInverse::point(const SurfacePoint& point, SampleSource& rng) const {
    if (point.shape == SurfacePoint::kNone || triangles_[point.shape].empty()) return std::nullopt;
    const EmitterDistribution& triangles = triangles_[point.shape];
    double before = 0;
    for (std::uint32_t k = 0; k < point.primitive; ++k) before += triangles.probability(k);
    const auto& mesh = std::get<TriangleMesh>(scene_->shapes()[point.shape].geometry);
    const auto& corners = mesh.triangles[point.primitive];
    const Imath::V3d a(mesh.positions[corners[0]]), e1 = Imath::V3d(mesh.positions[corners[1]]) - a,
                                                    e2 = Imath::V3d(mesh.positions[corners[2]]) - a,
                                                    p = Imath::V3d(point.p) - a;
    // Barycentric coordinates of the second and third corner.
    const double d11 = e1.dot(e1), d12 = e1.dot(e2), d22 = e2.dot(e2), dp1 = p.dot(e1), dp2 = p.dot(e2);
    const double det = d11 * d22 - d12 * d12;
    const double b1 = (d22 * dp1 - d12 * dp2) / det, b2 = (d11 * dp2 - d12 * dp1) / det;
    const double s = std::clamp(b1 + b2, 1e-9, 1 - 1e-9); // inverse of uniform_triangle()
    return {{between(choice_[point.emitter], choice_[point.emitter + 1], rng),
             between(before, before + triangles.probability(point.primitive), rng), s * s,
             std::clamp(b2 / s, 0.0, kBelowOne)}};
}

std::array<double, 2> EmitterInverse::ray(const SurfacePoint& point, const Vec3& w) const {
    const auto [sine2, around] = invert_hemisphere(Frame(point.ng).to_local(w));
    return {std::min(scene_->shapes()[point.shape].emission->profile.share_within(sine2), kBelowOne), around};
}

} // namespace keyhole
