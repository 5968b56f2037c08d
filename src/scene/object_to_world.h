// Where copies of meshes stand.
#pragma once

#include "core/vec.h"

#include <Imath/ImathMatrix.h>

namespace keyhole {

/// Row `i` of the linear part of a transform of row vectors: where it takes the i-th axis.
inline Imath::V3d row_of(const Imath::M44d& m, int i) { return {m[i][0], m[i][1], m[i][2]}; }

/// Of the linear part of a transform.
inline double linear_determinant(const Imath::M44d& m) { return row_of(m, 0).dot(row_of(m, 1).cross(row_of(m, 2))); }

/// The affine transform, regular, from the space of an object to where a copy of it stands in the world.
class ObjectToWorld {
  public:
    /// @param matrix of row vectors, as Imath has it.
    ObjectToWorld(const Imath::M44d& matrix); // NOLINT(google-explicit-constructor): it is that matrix
    const Imath::M44d& matrix() const { return matrix_; }

    Vec3 point(const Vec3& p) const { return Vec3(direction(Imath::V3d(p)) + matrix_.translation()); }
    Imath::V3d direction(const Imath::V3d& d) const {
        Imath::V3d moved;
        matrix_.multDirMatrix(d, moved);
        return moved;
    }
    /// The unit normal there of a surface with that normal here. It stays on its side where space is mirrored.
    Vec3 normal(const Vec3& n) const { return Vec3((Imath::V3d(n) * covectors_).normalized()); }
    /// Whether corners that ran anticlockwise run clockwise.
    bool is_mirrored() const { return mirrored_; }

    /// Bound on the error along unit `n`, in the world [m], of where the next ray finds a point of a copy: the ray's
    /// origin is rounded on its way to the space of the object, and so is the transform. `size` bounds the point's
    /// world coordinates.
    float rounding_along(const Vec3& n, const Vec3& size) const;
    /// At most that, whatever the normal, over the sum of the distances of the point and of the copy's own origin from
    /// the world's.
    float relative_rounding() const;
    /// Whether that stays within some multiple of what points in the world are rounded by anyway.
    bool rounds_little() const;

  private:
    Imath::M44d matrix_;
    Imath::M33d covectors_;
    Imath::M33f rounding_; // from sizes of coordinates to bounds on their errors, in the world
    Vec3 origin_;          // sizes of its coordinates in the world
    bool mirrored_;
};

} // namespace keyhole
