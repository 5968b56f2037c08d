// What a photon map stores: a photon, or its adjoint, an importon.
#pragma once

#include "photonmap/quantised.h"

#include <algorithm>
#include <array>

namespace keyhole {

/// Of some light, as shares of it or as luminance, what may take a way to the eye that is longer than the shortest by
/// 1, 2, ... vertices: see Photon::spare(). Longer ways than these are treated like the longest.
constexpr int kLongerWays = 4;
using LongerWays = std::array<float, kLongerWays>;
/// The entry for a way that is longer by `longer`, which is positive.
inline float by_way(const LongerWays& ways, int longer) {
    return ways[static_cast<std::size_t>(std::min(longer, kLongerWays) - 1)];
}

/// What a photon was before it arrived.
struct PhotonPast {
    static constexpr int kMostSpare = 7;

    bool caustic = false;   ///< see Photon::caustic()
    int spare = kMostSpare; ///< see Photon::spare(); not negative
};

/// Light that arrived at a surface, in 24 bytes. An importon has the same form: `direction` is then towards the eye's
/// side, and `power` the RGB importance that arrived from there.
class Photon {
  public:
    /// `ng` is the geometric normal; `direction` is unit and points away from the surface to where the light came from.
    /// `power` [W, or importance] is finite and not negative.
    Photon(const Vec3& position, const Vec3& ng, const Vec3& direction, const Rgb& power, const PhotonPast& past = {})
        : position_(position),
          power_(power, (past.caustic ? kCaustic : 0) | (ng.dot(direction) < 0 ? kBehind : 0) |
                            static_cast<unsigned>(std::min(past.spare, PhotonPast::kMostSpare)) << kSpare),
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
    /// By how many vertices its way to the eye may be longer than the shortest one, which is straight from d1, or from
    /// d2 by way of d1, before the path has more scatterings than `max_depth` allows; PhotonPast::kMostSpare: by so
    /// many or more. Of an importon: by how many the way that it came from the eye is longer.
    int spare() const { return static_cast<int>(power_.marks() >> kSpare); }
    /// Whether it may reach the eye by a way that is longer than the shortest one by `longer` vertices.
    bool reaches(int longer) const { return spare() >= std::min(longer, PhotonPast::kMostSpare); }
    void set_power(const Rgb& power) { power_ = SharedExponentRgb(power, power_.marks()); }

    bool operator==(const Photon&) const = default;

  private:
    static constexpr unsigned kCaustic = 1, kBehind = 2;
    static constexpr int kSpare = 2; // bit of the marks

    Vec3 position_;
    SharedExponentRgb power_;
    OctahedralVector<std::int16_t> direction_;
    OctahedralVector<std::int8_t> normal_;
};

static_assert(sizeof(Photon) == 24);

} // namespace keyhole
