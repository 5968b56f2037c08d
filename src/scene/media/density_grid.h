// How dense a medium is from place to place: values on a grid, and trilinear between them.
#pragma once

#include "core/bytes.h"
#include "core/vec.h"

#include <Imath/ImathBox.h>

#include <array>
#include <optional>
#include <vector>

namespace keyhole {

/// Values in the middle of the cells of a box, interpolated between them and with 0 beyond the faces of the box, which
/// cut them off at half their height; 0 outside (as in pbrt). Along a ray the density is a cubic in every cell between
/// values, so that integrals along rays are exact and need no random numbers. Immutable and thread-safe.
class DensityGrid {
  public:
    struct Values {
        std::array<int, 3> size{};  ///< along x, y, z; 1 or more
        std::vector<float> density; ///< [z][y][x], 0 or more
    };
    /// The box is `box` in a space that `to_world` brings into the world.
    /// @throws InputError if a matrix has no inverse, or the values are too few or too many.
    DensityGrid(Values values, const Imath::Box3d& box, const Imath::M44d& to_world);

    /// Of the box, in world space.
    const Imath::Box3f& bounds() const { return bounds_; }
    /// At a place in world space.
    double density(const Vec3& p) const;
    /// Integral of the density along `origin` + t `w` (unit) for t from `t0` to `t1`, which may be infinite [m].
    double integral(const Vec3& origin, const Vec3& w, double t0, double t1) const;
    /// The t at which integral() from `t0` on comes to `amount`; none if it doesn't before `t1`.
    std::optional<double> reach(const Vec3& origin, const Vec3& w, double t0, double t1, double amount) const;
    void add_to(Hash& hash) const;

  private:
    using Place = Imath::V3d; // in which values lie at whole numbers

    struct Ray {
        Place origin, w;
        Place at(double t) const { return origin + w * t; }
    };
    Ray local(const Vec3& origin, const Vec3& w) const;
    double value(int x, int y, int z) const;
    double interpolated(const Place& p) const;
    /// Of a part of a ray within which the density is a cubic.
    double cubic_integral(const Ray& ray, double a, double b, double at_a, double at_b) const;
    template <class F> void for_each_part(const Ray& ray, double t0, double t1, F&& f) const;

    Values values_;
    Imath::M44d to_grid_;
    Imath::Box3f bounds_;
};

} // namespace keyhole
