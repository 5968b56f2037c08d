// How much surface lies around a point: what a density estimate divides by where a disc would stick out over an edge.
#pragma once

#include "photonmap/box_tree.h"
#include "photonmap/surface_region.h"
#include "scene/shape.h"

#include <cstdint>
#include <vector>

namespace keyhole {

/// The surfaces of a scene that photons can lie on: those whose material has a finite part. Immutable and thread-safe;
/// refers to the shapes, which must outlive it.
class SurfacePatches {
  public:
    explicit SurfacePatches(const std::vector<Shape>& shapes);

    /// Area [m^2] of the surface inside the region of radius `r`, counted on the region's side. Exact for triangles,
    /// and on a sphere for regions about a point of it; a sphere that is only near by is left out. Surfaces in contact
    /// (a box on a floor) both count, although photons reach only one; so the area is held to that of the disc, pi r^2.
    double area(const SurfaceRegion& region, double r) const;

    /// Whether other surfaces may stand on the region of radius `r`, where they could part one half of it from the
    /// other. By bounding boxes: true more often than need be on slanted and curved surfaces.
    bool obstructed(const SurfaceRegion& region, double r) const;

  private:
    struct Patch {
        std::uint32_t shape, triangle;
    };
    double triangle_area(const Patch& patch, const SurfaceRegion& region, double r) const;

    const std::vector<Shape>& shapes_;
    std::vector<Patch> patches_;
    BoxTree tree_;
};

} // namespace keyhole
