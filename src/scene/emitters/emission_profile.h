// How the light of a surface spreads about its normal.
#pragma once

#include "core/vec.h"

namespace keyhole {

/// What a spot's light is, for a cosine that is the share t of the way from the edge of its cone to full light.
enum class SpotFade {
    smooth,  ///< smoothstep(t): pbrt's
    squared, ///< t^2: glTF's
};

/// How a spot fades: 1 from the cosine `full` on, down to 0 at `edge`.
inline double spot_falloff(double cosine, double full, double edge, SpotFade fade = SpotFade::smooth) {
    if (cosine >= full) return 1;
    if (cosine <= edge) return 0;
    const double t = (cosine - edge) / (full - edge);
    return fade == SpotFade::squared ? t * t : t * t * (3 - 2 * t);
}

/// Radiance by the angle from the normal, over that along it. Immutable.
class EmissionProfile {
  public:
    /// The same in all directions: Lambertian.
    EmissionProfile() = default;
    /// Through a grid of fine slats, as before a soft box: 1 - tan(angle) / tan(spread / 2), 0 beyond.
    /// @param spread_degrees above 0, at most 180: without the grid.
    static EmissionProfile grid(double spread_degrees);
    /// That of a spot light: 1 up to `full_degrees`, then smoothstep of the cosine to 0 at `edge_degrees`, at most 90.
    static EmissionProfile cone(double full_degrees, double edge_degrees);

    /// For the cosine of an angle below 90 degrees.
    double value(double cosine) const {
        if (kind_ == Kind::lambertian) return 1;
        return kind_ == Kind::grid ? through_grid(cosine) : spot_falloff(cosine, cos_full_, cos_edge_);
    }
    /// Integral of value() times the cosine over the directions of one side [sr]: pi of a Lambertian surface.
    double projected_solid_angle() const { return projected_; }
    /// Share of the power that leaves within an angle with that sine squared.
    double share_within(double sine2) const;
    /// The sine squared within which that share of the power leaves.
    double sine2_of_share(double share) const;
    /// Largest angle with light [rad].
    double reach() const { return reach_; }

  private:
    enum class Kind { lambertian, grid, cone };
    EmissionProfile(Kind kind, double inner, double reach);

    double through_grid(double cosine) const;
    /// Power within an angle, over radiance along the normal and area.
    double power_within(double sine2) const;

    Kind kind_ = Kind::lambertian;
    double tangent_ = 0;                 // of a grid's reach
    double cos_full_ = 0, cos_edge_ = 0; // of a cone
    double reach_ = kPi / 2, projected_ = kPi;
};

} // namespace keyhole
