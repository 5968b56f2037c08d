#include "scene/media.h"

#include <algorithm>
#include <limits>

namespace keyhole {

float beyond_boundary(float nearest, float met, float skip) {
    const float from = std::max(nearest, met);
    return std::max(std::nextafter(from, std::numeric_limits<float>::infinity()), from + skip);
}

Media::Media(const std::vector<Shape>& shapes, std::shared_ptr<const Medium> outermost)
    : shapes_(shapes), outermost_(std::move(outermost)) {
    if (std::ranges::none_of(shapes, bounds_media)) return;
    accelerator_ = std::make_unique<Accelerator>();
    for (std::uint32_t i = 0; i < shapes.size(); ++i)
        if (bounds_media(shapes[i])) accelerator_->attach(shapes[i], i);
    accelerator_->commit();
}

/// The medium on the side of a boundary that `w` points to.
const Medium* Media::medium_beside(const SurfacePoint& point, const Vec3& w) const {
    const Shape& shape = shapes_[point.shape];
    return point.ng.dot(w) > 0 ? shape.outside.get() : shape.inside.get();
}

Rgb Media::transmittance(const SurfacePoint& a, const SurfacePoint& b) const {
    if (empty()) return Rgb(1.0);
    const SurfacePoint &from = a.site == Site::infinite ? b : a, &to = a.site == Site::infinite ? a : b;
    const Vec3 w = direction(from, to), origin = from.ray_origin(w);
    const float end = to.site == Site::infinite
                          ? std::numeric_limits<float>::infinity()
                          : ((to.site == Site::point ? to.ray_origin(-w) : to.p) - origin).length();

    const bool on_boundary = from.site == Site::surface && bounds_media(shapes_[from.shape]);
    const Medium* behind = on_boundary ? medium_beside(from, w) : outermost_.get();
    Rgb left(1.0);
    // The side on which the next boundary is met tells the medium before it. The search goes on past the end, for what
    // lies there shows what the end lies in; its own surface does so at no distance.
    float t = 0;
    while (t < end) {
        const auto hit = accelerator_ ? accelerator_->intersect(origin, w, t) : std::nullopt;
        const SurfacePoint met = hit ? hit_point(shapes_[hit->shape], *hit, origin, w) : SurfacePoint();
        const Medium* medium = hit ? medium_beside(met, -w) : behind;
        const float stop = hit ? std::clamp(hit->t, t, end) : end;
        if (medium != nullptr) left *= medium->transmittance(stop - t);
        if (!hit) break;
        behind = medium_beside(met, w);
        // Beyond this surface: by what its position may be off, which is more where it is met at a slant.
        const float slant = std::max(0.001f, std::abs(met.ng.dot(w)));
        t = beyond_boundary(t, hit->t, met.offset / slant);
    }
    return left;
}

} // namespace keyhole
