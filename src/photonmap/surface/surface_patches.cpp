#include "photonmap/surface/surface_patches.h"

#include "photonmap/surface/disc_area.h"
#include "photonmap/surface/sight.h"
#include "scene/geometry.h"

#include <algorithm>
#include <array>
#include <limits>

namespace keyhole {
namespace {

using Imath::V3d;

constexpr double kFlat = SurfaceRegion::kFlattening;

/// Of a scene: a tree of more would take longer to build than a short render lasts.
constexpr std::size_t kMostInTree = 150'000;
constexpr int kRing = 8; // rays that look for edges of a region
constexpr double kRingRadius = 0.85;
constexpr double kWhole = 0.999; // share of surface at a place that leaves no gap
// Rays that measure a region at an edge: the first of these numbers of which so many hit its surface. With fewer hits
// the mean of the reciprocal would be far too large.
constexpr std::array kRays{32, 128, 512};
constexpr int kHits = 8;
constexpr int kMostLayers = 8; // of surface in a region, one above the other
/// Of the radius, how far above a region's middle rays start: what lies lower is its own surface.
constexpr float kOffSurface = 1e-3f;

bool holds_photons(const Shape& shape) {
    return !is_interface(shape) && (shape.material == nullptr || shape.material->traits().finite);
}

/// Area inside the region of the sphere that it is centred on; 0 for a sphere that it isn't centred on.
double cap_area(const Sphere& sphere, const SurfaceRegion& region, double r) {
    const V3d out = V3d(region.position) - V3d(sphere.center);
    const double radius = sphere.radius, distance = out.length();
    if (std::abs(distance - radius) > 1e-3 * radius) return 0;
    if (std::abs(out.dot(V3d(region.normal))) < 0.99 * distance) return 0;
    // A point at depth h below the top of the cap has distance^2 = 2 R h + (flat^2 - 1) h^2 in the region's measure.
    const double depth = r * r / (radius + std::sqrt(radius * radius + (kFlat * kFlat - 1) * r * r));
    return 2 * kPi * radius * std::min(depth, radius * (1 - SurfaceRegion::kMinCosine));
}

Imath::Box3f bounds_of(const Sphere& sphere) {
    return {sphere.center - Vec3(sphere.radius), sphere.center + Vec3(sphere.radius)};
}

/// What light goes through, or is thrown back by, without leaving photons.
bool parts_photons(const Shape& shape) { return !is_interface(shape) && !holds_photons(shape); }

/// Surfaces of a region by the side that they show.
class Sides {
  public:
    /// Whether a solid lies between this surface, `height` above the region's middle, and others: one that faces the
    /// region's way above one that faces the other way, whatever shapes they are of.
    bool enclose(bool faces_up, float height, double r) {
        if (faces_up)
            top_ = std::max(top_, height);
        else
            bottom_ = std::min(bottom_, height);
        return top_ > bottom_ + kInContact * static_cast<float>(r);
    }

  private:
    static constexpr float kInContact = 1e-3f; // of a radius, in height: a box and the floor that it stands on
    float top_ = -std::numeric_limits<float>::infinity(), bottom_ = std::numeric_limits<float>::infinity();
};

std::vector<FloatTexture> finite_shares(const std::vector<Shape>& shapes) {
    std::vector<FloatTexture> shares;
    shares.reserve(shapes.size());
    for (const Shape& s : shapes) shares.push_back(s.material != nullptr ? s.material->finite_share() : nullptr);
    return shares;
}

/// Box around the ellipsoid of a region.
Imath::Box3f bounds_of(const SurfaceRegion& region, double r) {
    Vec3 half;
    for (int i = 0; i < 3; ++i) {
        const double n = region.normal[i];
        half[i] = static_cast<float>(r * std::sqrt(std::max(0.0, 1 - n * n * (1 - 1 / (kFlat * kFlat)))) * 1.0001);
    }
    return {region.position - half, region.position + half};
}

} // namespace

SurfacePatches::SurfacePatches(const Scene& scene)
    : shapes_(scene.shapes()), scene_(&scene), shares_(finite_shares(shapes_)),
      has_tree_(scene.triangle_count() <= kMostInTree), surfaces_(index_of(holds_photons)),
      others_(index_of(parts_photons)) {}

SurfacePatches::SurfacePatches(const std::vector<Shape>& shapes)
    : shapes_(shapes), has_tree_(true), surfaces_(index_of(holds_photons)), others_(index_of(parts_photons)) {}

SurfacePatches::Index SurfacePatches::index_of(bool (*wanted)(const Shape& shape)) const {
    std::vector<Patch> patches;
    std::vector<Imath::Box3f> boxes;
    for (std::uint32_t s = 0; has_tree_ && s < shapes_.size(); ++s) {
        if (!wanted(shapes_[s])) continue;
        const bool whole = std::holds_alternative<Sphere>(shapes_[s].geometry);
        const auto n = static_cast<std::uint32_t>(whole ? 1 : triangle_count(shapes_[s]));
        for (std::uint32_t t = 0; t < n; ++t) boxes.push_back(bounds(patches.emplace_back(Patch{s, t})));
    }
    return {std::move(patches), BoxTree(boxes)};
}

Imath::Box3f SurfacePatches::bounds(const Patch& patch) const {
    const Shape& shape = shapes_[patch.shape];
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) return bounds_of(*sphere);
    Imath::Box3f box;
    for (const Vec3& p : triangle_corners(shape, patch.triangle)) box.extendBy(p);
    return box;
}

double SurfacePatches::area(const SurfaceRegion& region, double r) const {
    if (!has_tree_) return area_by_rays(region, r);
    double sum = 0;
    int met = 0;
    Sides sides;
    const bool sums_tell = surfaces_.tree.overlapping(bounds_of(region, r), [&](std::uint32_t i) {
        if (scene_ != nullptr && ++met > kMostTriangles) return false;
        const Patch& patch = surfaces_.patches[i];
        const auto* sphere = std::get_if<Sphere>(&shapes_[patch.shape].geometry);
        const Part part = sphere != nullptr ? Part{cap_area(*sphere, region, r)} : triangle_part(patch, region, r);
        sum += part.area;
        if (scene_ == nullptr || part.area == 0) return true;
        return !is_patchy(patch.shape) && (sphere != nullptr || !sides.enclose(part.faces_up, part.height, r));
    });
    return sums_tell ? std::min(sum, kPi * r * r) : area_by_rays(region, r);
}

/// Area of the surface in the region over that of its projection, at a place of the disc (polar coordinates), where
/// `counts(point)`. All layers count: a photon on any of them is found there.
template <class Counts>
double SurfacePatches::surface_over(const SurfaceRegion& region, double r, double distance, double angle,
                                    const Counts& counts) const {
    const Frame frame(region.normal);
    const double height = std::sqrt(r * r - distance * distance) / kFlat;
    SurfacePoint from;
    from.site = Site::point;
    from.p = region.position + frame.s * static_cast<float>(distance * std::cos(angle)) +
             frame.t * static_cast<float>(distance * std::sin(angle)) + frame.n * static_cast<float>(height);
    const Vec3 top = from.p;
    double sum = 0;
    double into = 0; // the cosine with which the ray went into the solid that it is in; 0: it is in none
    for (int layer = 0; layer < kMostLayers; ++layer) {
        const auto hit = scene_->trace(from, -frame.n);
        if (!hit || hit->site != Site::surface || !((hit->p - top).length() <= 2 * height)) break;
        from = *hit;
        const double cosine = hit->ng.dot(frame.n);
        if (!holds_photons(shapes_[hit->shape])) continue;
        if (into * cosine < 0) { // seen from within: no photon comes to that side
            into = 0;
            continue;
        }
        into = cosine;
        if (!(std::abs(cosine) > SurfaceRegion::kMinCosine) || !counts(*hit)) continue;
        const FloatTexture& share = shares_[hit->shape];
        sum += (share != nullptr ? share->value(*hit) : 1.0) / std::abs(cosine);
    }
    return sum;
}

template <class Counts>
double SurfacePatches::sampled_area(const SurfaceRegion& region, double r, const Counts& counts) const {
    double share = 0;
    for (const int rays : kRays) {
        double sum = 0;
        int hits = 0;
        for (int i = 0; i < rays; ++i) {
            const double there = surface_over(region, r, r * std::sqrt((i + 0.5) / rays), kGoldenAngle * i, counts);
            hits += there > 0 ? 1 : 0;
            sum += there;
        }
        share = sum / rays;
        if (hits >= kHits) break;
    }
    return kPi * r * r * std::min(1.0, share);
}

/// Nearly all regions lie away from edges, which a few rays near the border tell.
double SurfacePatches::area_by_rays(const SurfaceRegion& region, double r) const {
    const auto all = [](const SurfacePoint&) { return true; };
    int covered = 0;
    while (covered < kRing && surface_over(region, r, kRingRadius * r, 2 * kPi * covered / kRing, all) > kWhole)
        ++covered;
    return covered == kRing ? kPi * r * r : sampled_area(region, r, all);
}

double SurfacePatches::area_in_sight(const SurfaceRegion& region, double r, float lift) const {
    if (scene_ == nullptr) return 0;
    double all = 0, seen = 0;
    const double sampled = sampled_area(region, r, [&](const SurfacePoint& p) {
        all += 1;
        seen += in_sight(*scene_, region, lift, p.p) ? 1 : 0;
        return true;
    });
    return seen > 0 ? (has_tree_ ? area(region, r) : sampled) * seen / all : 0;
}

float SurfacePatches::free_height(const SurfaceRegion& region, double r) const {
    constexpr float kNone = std::numeric_limits<float>::infinity();
    if (scene_ == nullptr) return kNone;
    SurfacePoint from;
    from.p = region.position;
    from.ng = region.normal;
    // Far from the origin rounding is the larger one, and the surface itself would be met.
    from.offset =
        std::max(kOffSurface * static_cast<float>(r), 2 * scene_->rounding_along(region.normal, region.position));
    for (int layer = 0; layer < kMostLayers; ++layer) {
        const auto hit = scene_->trace(from, region.normal);
        if (!hit || hit->site != Site::surface) return kNone;
        if (holds_photons(shapes_[hit->shape])) return (hit->p - region.position).length();
        from = *hit;
    }
    return kNone;
}

bool SurfacePatches::obstructed(const SurfaceRegion& region, double r) const {
    if (!has_tree_) return obstructed_by_rays(region, r);
    // The slab above what counts as the same surface.
    SurfaceRegion above = region;
    above.position += region.normal * static_cast<float>(2 * r / kFlat);
    const Imath::Box3f slab = bounds_of(above, r);
    int met = 0;
    bool found = false;
    const auto look = [&](const Index& index) {
        return index.tree.overlapping(slab, [&](std::uint32_t i) {
            if (scene_ != nullptr && ++met > kMostTriangles) return false;
            found |= bounds(index.patches[i]).intersects(slab);
            return true;
        });
    };
    return look(surfaces_) && look(others_) ? found : obstructed_by_rays(region, r);
}

/// Rays go out from above the middle, through the slab, to the region's border.
bool SurfacePatches::obstructed_by_rays(const SurfaceRegion& region, double r) const {
    const Frame frame(region.normal);
    const Vec3 from = region.position + frame.n * static_cast<float>(2 * r / kFlat);
    for (int i = 0; i < kRing; ++i) {
        const double angle = 2 * kPi * i / kRing;
        const Vec3 w = frame.s * static_cast<float>(std::cos(angle)) + frame.t * static_cast<float>(std::sin(angle));
        if (!scene_->visible(from, from + w * static_cast<float>(r))) return true;
    }
    return false;
}

/// Stretched along the normal, the ellipsoid becomes a sphere, which cuts the triangle's plane in a disc; areas in that
/// plane all shrink by one factor on the way back.
SurfacePatches::Part SurfacePatches::triangle_part(const Patch& patch, const SurfaceRegion& region, double r) const {
    const auto corners = triangle_corners(shapes_[patch.shape], patch.triangle);
    const V3d n(region.normal);
    std::array<V3d, 3> p;
    for (std::size_t i = 0; i < 3; ++i) p[i] = V3d(corners[i]) - V3d(region.position);
    const V3d cross = (p[1] - p[0]).cross(p[2] - p[0]);
    const double facing = cross.dot(n), twice_area = cross.length();
    if (!(std::abs(facing) > SurfaceRegion::kMinCosine * twice_area)) return {};
    const auto above = static_cast<float>(cross.dot(p[0]) / facing);

    for (V3d& v : p) v += n * ((kFlat - 1) * v.dot(n));
    const V3d stretched = (p[1] - p[0]).cross(p[2] - p[0]);
    const double twice_stretched = stretched.length();
    const V3d plane_normal = stretched / twice_stretched;
    const double height = p[0].dot(plane_normal);
    if (std::abs(height) >= r) return {};

    const V3d s = (p[1] - p[0]).normalized(), u = plane_normal.cross(s);
    const auto flat = [&](const V3d& v) { return Imath::V2d(v.dot(s), v.dot(u)); };
    const double disc = std::sqrt(r * r - height * height);
    const double inside = disc_triangle_area(flat(p[0]), flat(p[1]), flat(p[2]), disc);
    return {inside * (twice_area / twice_stretched), facing > 0, above};
}

} // namespace keyhole
