// What a photon map stores: a photon, or its adjoint, an importon.
#pragma once

#include "photonmap/quantised.h"

namespace keyhole {

/// Light that arrived at a surface, in 24 bytes. An importon has the same form: `direction` is then towards the eye's
/// side, and `power` the RGB importance that arrived from there.
class Photon {
  public:
    /// `ng` is the geometric normal; `direction` is unit and points away from the surface to where the light came from.
    /// `power` [W, or importance] is finite and not negative. `caustic`: see caustic().
    Photon(const Vec3& position, const Vec3& ng, const Vec3& direction, const Rgb& power, bool caustic = false)
        : position_(position), power_(power, (caustic ? kCaustic : 0) | (ng.dot(direction) < 0 ? kBehind : 0)),
          direction_(direction), normal_(facing(ng, direction)) {}

    const Vec3& position() const { return position_; }
    /// Geometric normal on the side that the light arrived at, so that the two sides of a sheet are told apart.
    const OctahedralVector<std::int8_t>& normal() const { return normal_; }
    Vec3 direction() const { return direction_.decode(); }
    Rgb power() const { return power_.decode(); }
    /// Whether specular vertices alone scattered the light before (L S+ D). A photon of the global map may be one, too.
    bool caustic() const { return (power_.marks() & kCaustic) != 0; }
    /// Whether it arrived on the side that the surface's geometric normal turns away from.
    bool behind() const { return (power_.marks() & kBehind) != 0; }
    void set_power(const Rgb& power) { power_ = SharedExponentRgb(power, power_.marks()); }

    bool operator==(const Photon&) const = default;

  private:
    static constexpr unsigned kCaustic = 1, kBehind = 2;

    Vec3 position_;
    SharedExponentRgb power_;
    OctahedralVector<std::int16_t> direction_;
    OctahedralVector<std::int8_t> normal_;
};

static_assert(sizeof(Photon) == 24);

} // namespace keyhole
