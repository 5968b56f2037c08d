// Rays against shapes. Of Embree accelerator.cpp knows, and ball_tree.cpp, nobody else.
#pragma once

#include "scene/shape.h"

#include <memory>
#include <optional>
#include <vector>

namespace keyhole {

/// Where a ray meets a shape.
struct RayHit {
    std::uint32_t shape;     ///< its index
    std::uint32_t primitive; ///< triangle within it
    float u, v;              ///< barycentric coordinates on a triangle, as triangle_point() has them
    float t;                 ///< along the ray's direction, in its lengths
};

/// The point of `shape` that a ray from `origin` along `direction` met. Its emitter is left out, and the
/// parametrisation where nothing reads it.
SurfacePoint hit_point(const Shape& shape, const RayHit& hit, const Vec3& origin, const Vec3& direction);

/// A bounding volume hierarchy over shapes. Where a shape has an alpha texture, rays pass its holes; others don't pay
/// for that. Of an object that has copies there is one hierarchy, which holds the meshes that stand in its space, and
/// one of all copies. Thread-safe once committed.
class Accelerator {
  public:
    /// The shapes must outlive this, and stay where they are.
    explicit Accelerator(const std::vector<Shape>& shapes);
    ~Accelerator();
    Accelerator(const Accelerator&) = delete;
    Accelerator& operator=(const Accelerator&) = delete;

    /// Adds a shape, by its index. Those of one copy of an object form one instance if nothing but them is attached
    /// in between, or shapes that are no instances.
    void attach(std::uint32_t index);
    /// Builds; to be called once, before rays.
    void commit();

    /// The first hit at t in [nearest, inf).
    std::optional<RayHit> intersect(const Vec3& origin, const Vec3& direction, float nearest = 0) const;
    /// Whether anything is hit at t in [0, farthest].
    bool occluded(const Vec3& origin, const Vec3& direction, float farthest) const;

    /// Bounding box of all shapes, of copies that around the box of their object; lower > upper if there are none.
    Vec3 lower() const;
    Vec3 upper() const;

    /// Memory that Embree holds for this.
    std::size_t bytes() const;

  private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
};

} // namespace keyhole
