// Curves of pbrt's format: hair, fur, threads, blades of grass.
#pragma once

#include "scene/load/pbrt/syntax/parameters.h"
#include "scene/shape.h"

#include <cstdint>
#include <vector>

namespace keyhole::pbrt {

/// Curves of one or of many directives, in their own space: splines of any kind as cubic Bezier segments. They are kept
/// like this until all are read, as a mesh of them takes ten times the memory.
struct CurveSet {
    struct Curve {
        std::uint32_t segments; ///< each begins where the last one ends
        float width0, width1;   ///< diameter, or width of a ribbon, at either end; linear in the parameter between
        bool is_ribbon;         ///< otherwise a tube
    };
    std::vector<Curve> curves;
    std::vector<Vec3> points;  ///< of each curve: 3 for each segment, and its end
    std::vector<Vec3> normals; ///< unit; of each ribbon: one where a segment begins, and one at the end

    void append(const CurveSet& more);
};

/// Reads a `curve`: `P`, `basis`, `degree`, `type`, `N`, `width`, `width0`, `width1`. `flat` curves, which turn towards
/// whoever looks, become tubes, as those are the same from everywhere (a warning).
/// @throws InputError for unknown kinds of curves, points that don't make up whole segments, negative widths, and
/// ribbons without a normal at each end of a segment.
CurveSet read_curve(Parameters& parameters);

/// Tubes, open at their ends, with as many sides as a ring needs not to be seen as a polygon, and ribbons, which turn
/// about the curve from normal to normal. The corners of a tube lie as far outside as gives it the circumference of the
/// circle, so that its area and, by Cauchy's formula, the mean width that it is seen with are right with few sides.
/// Normals are smooth.
/// @param parametrised gives texture coordinates: u along each segment, as in pbrt; v across a ribbon, and from 0 to 1
/// and back around a tube, of which half is seen at a time.
/// @throws InputError, without a position, for more than kMaxMeshTriangles triangles.
TriangleMesh mesh_of_curves(const CurveSet& set, bool parametrised);

} // namespace keyhole::pbrt
