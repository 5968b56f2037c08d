// How much surface lies around a point: what a density estimate divides by where a disc would stick out over an edge.
#pragma once

#include "photonmap/surface/box_tree.h"
#include "photonmap/surface/surface_region.h"
#include "scene/scene.h"

#include <cstdint>
#include <vector>

namespace keyhole {

/// The surfaces of a scene that photons can lie on: those whose material has a finite part. Where exact sums of
/// triangles would take long, or not tell, a few rays look instead: where more than kMostTriangles lie in a region, so
/// that a question costs the same however fine the meshes are; everywhere in scenes too fine for a tree of their
/// triangles; on surfaces of which only some places can hold photons, for opacity or a mix of materials; and on solids
/// so thin that both of their sides lie in a region, of which photons are found on one. Immutable and thread-safe;
/// refers to the shapes and the scene, which must outlive it.
class SurfacePatches {
  public:
    explicit SurfacePatches(const Scene& scene);
    /// Without a scene to send rays into: always exact, whatever that takes.
    explicit SurfacePatches(const std::vector<Shape>& shapes);

    /// Area [m^2] of the surface inside the region of radius `r`, one side of it: which side is the outside doesn't
    /// matter. Exact for triangles, and on a sphere for regions about a point of it; a sphere that is only near by is
    /// left out. By rays it is known to about 4 % of the disc where an edge goes through the region, and exact away
    /// from edges. Surfaces in contact (a box on a floor) both count, although photons reach only one; so the area is
    /// held to that of the disc, pi r^2.
    double area(const SurfaceRegion& region, double r) const;

    /// Area [m^2] of what the region's middle sees of that surface (in_sight()), by rays; 0 where it sees nothing, as
    /// in a crevice, and without a scene.
    double area_in_sight(const SurfaceRegion& region, double r, float lift) const;

    /// Distance from the middle of the region of radius `r` to the first surface above it that holds photons [m];
    /// infinite where there is none, and without a scene.
    float free_height(const SurfaceRegion& region, double r) const;

    /// Whether other surfaces, glass and mirrors among them, may stand on the region of radius `r`, where they could
    /// part one half of it from the other. By bounding boxes: true more often than need be on slanted and curved
    /// surfaces; by rays along the surface where there are too many.
    bool obstructed(const SurfaceRegion& region, double r) const;

    /// Whether the scene is too fine for a tree of its triangles, so that every area takes rays.
    bool takes_rays() const { return !has_tree_; }

    /// Triangles in a region that are added up one by one.
    static constexpr int kMostTriangles = 64;

  private:
    struct Patch {
        std::uint32_t shape, triangle;
    };
    /// Triangles and spheres of some shapes.
    struct Index {
        std::vector<Patch> patches; ///< of the tree's boxes
        BoxTree tree;
    };
    /// Empty without has_tree_.
    Index index_of(bool (*wanted)(const Shape& shape)) const;
    Imath::Box3f bounds(const Patch& patch) const;
    /// Whether photons can lie at some of its places and not at others.
    bool is_patchy(std::uint32_t shape) const { return shapes_[shape].alpha != nullptr || shares_[shape] != nullptr; }
    /// What of a triangle lies in a region.
    struct Part {
        double area = 0;      ///< [m^2]
        bool faces_up = true; ///< the region's way
        float height = 0;     ///< of its plane over the region's middle [m]
    };
    Part triangle_part(const Patch& patch, const SurfaceRegion& region, double r) const;
    double area_by_rays(const SurfaceRegion& region, double r) const;
    template <class Counts>
    double surface_over(const SurfaceRegion& region, double r, double distance, double angle,
                        const Counts& counts) const;
    /// Area of what `counts(point)` of the surface in the region, by rays through it against its normal.
    template <class Counts> double sampled_area(const SurfaceRegion& region, double r, const Counts& counts) const;
    bool obstructed_by_rays(const SurfaceRegion& region, double r) const;

    const std::vector<Shape>& shapes_;
    const Scene* scene_ = nullptr;     // null: there are no rays
    std::vector<FloatTexture> shares_; // by shape: Material::finite_share()
    bool has_tree_;
    Index surfaces_; // that hold photons
    Index others_;   // glass and mirrors, which part photons all the same
};

} // namespace keyhole
