#include "scene/media/media.h"

#include <algorithm>
#include <array>
#include <limits>

namespace keyhole {
namespace {

/// Length times density of a part of an edge.
double depth(const Medium& medium, const Vec3& origin, const Vec3& w, float t0, float t1) {
    return medium.density ? medium.density->integral(origin, w, t0, t1) : static_cast<double>(t1 - t0);
}

bool any_scatters(const std::vector<Shape>& shapes, const Medium* outermost) {
    const auto scatters = [](const Medium* m) { return m != nullptr && m->scatters(); };
    return scatters(outermost) || std::ranges::any_of(shapes, [&](const Shape& s) {
               return bounds_media(s) && (scatters(s.inside.get()) || scatters(s.outside.get()));
           });
}

} // namespace

float beyond_boundary(float nearest, float met, float skip) {
    const float from = std::max(nearest, met);
    return std::max(std::nextafter(from, std::numeric_limits<float>::infinity()), from + skip);
}

Media::Media(const std::vector<Shape>& shapes, std::shared_ptr<const Medium> outermost)
    : shapes_(shapes), outermost_(std::move(outermost)), scatter_(any_scatters(shapes, outermost_.get())) {
    if (std::ranges::none_of(shapes, bounds_media)) return;
    accelerator_ = std::make_unique<Accelerator>(shapes);
    for (std::uint32_t i = 0; i < shapes.size(); ++i)
        if (bounds_media(shapes[i])) accelerator_->attach(i);
    accelerator_->commit();
}

/// The medium on the side of a boundary that `w` points to.
const Medium* Media::medium_beside(const SurfacePoint& point, const Vec3& w) const {
    const Shape& shape = shapes_[point.shape];
    return point.ng.dot(w) > 0 ? shape.outside.get() : shape.inside.get();
}

Media::Edge Media::edge(const SurfacePoint& from, const Vec3& w, const SurfacePoint* to) {
    const Vec3 origin = from.ray_origin(w);
    const float end = to == nullptr || to->site == Site::infinite
                          ? std::numeric_limits<float>::infinity()
                          : ((to->site == Site::point ? to->ray_origin(-w) : to->p) - origin).length();
    return {origin, w, end, from};
}

/// Calls f(medium, t0, t1), which returns whether to go on, for the parts of the edge that a medium fills, in order.
template <class F> void Media::for_each_part(const Edge& edge, F&& f) const {
    const auto& [origin, w, end, from] = edge;
    const bool on_boundary = from.site == Site::surface && bounds_media(shapes_[from.shape]);
    const Medium* behind = on_boundary ? medium_beside(from, w) : outermost_.get();
    // The side on which the next boundary is met tells the medium before it. The search goes on past the end, for what
    // lies there shows what the end lies in; its own surface does so at no distance.
    float t = 0;
    while (t < end) {
        const auto hit = accelerator_ ? accelerator_->intersect(origin, w, t) : std::nullopt;
        const SurfacePoint met = hit ? hit_point(shapes_[hit->shape], *hit, origin, w) : SurfacePoint();
        const Medium* medium = hit ? medium_beside(met, -w) : behind;
        const float stop = hit ? std::clamp(hit->t, t, end) : end;
        if (medium != nullptr && !f(*medium, t, stop)) return;
        if (!hit) break;
        behind = medium_beside(met, w);
        // Beyond this surface: by what its position may be off, which is more where it is met at a slant.
        const float slant = std::max(0.001f, std::abs(met.ng.dot(w)));
        t = beyond_boundary(t, hit->t, met.offset / slant);
    }
}

Imath::Box3f Media::bounds_of_scattering() const {
    Imath::Box3f box;
    if (!scatter_) return box;
    const auto add = [&box](const Medium* medium) {
        if (medium != nullptr && medium->density) box.extendBy(medium->density->bounds());
    };
    add(outermost_.get());
    for (const Shape& shape : shapes_) {
        add(shape.inside.get());
        add(shape.outside.get());
    }
    if (accelerator_) {
        box.extendBy(accelerator_->lower());
        box.extendBy(accelerator_->upper());
    }
    return box;
}

Attenuation Media::attenuation(const SurfacePoint& a, const SurfacePoint& b) const {
    Attenuation attenuation;
    if (empty()) return attenuation;
    const SurfacePoint &from = a.site == Site::infinite ? b : a, &to = a.site == Site::infinite ? a : b;
    const Edge along = edge(from, direction(from, to), &to);
    for_each_part(along, [&](const Medium& medium, float t0, float t1) {
        attenuation.pass(medium, depth(medium, along.origin, along.w, t0, t1));
        return true;
    });
    return attenuation;
}

FreeFlight Media::fly(const SurfacePoint& from, const Vec3& w, const SurfacePoint* to, int primary, double u) const {
    const Edge along = edge(from, w, to);
    double left = -std::log1p(-u); // of the optical depth at which it collides
    FreeFlight flight;
    for_each_part(along, [&](const Medium& medium, float t0, float t1) {
        const double whole = depth(medium, along.origin, w, t0, t1);
        const double extinction = medium.scatters() ? medium.extinction()[primary] : 0;
        const double amount = extinction > 0 ? std::min(whole, left / extinction) : whole;
        std::optional<double> t;
        if (amount < whole)
            t = medium.density ? medium.density->reach(along.origin, w, t0, t1, amount) : std::optional(t0 + amount);
        flight.attenuation.pass(medium, t ? amount : whole);
        if (!t) {
            if (extinction > 0) left = std::max(0.0, left - extinction * whole);
            return true;
        }
        const Vec3 p = along.origin + w * static_cast<float>(*t);
        const double density = medium.density ? medium.density->density(p) : 1;
        flight.collision = Collision{p, medium.scattering * density, medium.extinction() * density, medium.anisotropy};
        return false;
    });
    return flight;
}

} // namespace keyhole
