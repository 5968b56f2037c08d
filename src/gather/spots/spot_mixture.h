// A ray that a diffuse surface sends on, aimed at hot spots now and then.
#pragma once

#include "core/inline_vector.h"
#include "gather/spots/hot_spots.h"

namespace keyhole {

/// Two techniques for one ray: the first draws from the BSDF, and meets a spot so rarely that it brings hundreds of
/// times its share; the second draws in the cones that spots fill. One of them is chosen, and judged by the density of
/// both (balance heuristic of the one-sample model, Veach 1997, section 9.2.4).
class SpotMixture {
  public:
    /// @param irradiance at `p` that spots are told from, as luminance [W/m^2]; more or less
    SpotMixture(const HotSpots& spots, const Vec3& p, const Vec3& normal, double irradiance);

    /// Probability of the second technique; 0 where no spot shines.
    double aimed() const { return aimed_; }
    /// A direction by the second technique.
    Vec3 sample(SampleSource& source) const;
    /// Density of a direction per solid angle [1/sr], which the BSDF draws with density `pdf`.
    double density(const Vec3& w, double pdf) const;

  private:
    struct Cone {
        Vec3 axis; ///< unit
        double cos_half_angle;
        double irradiance; ///< about what comes from there [W/m^2]
        double pdf;        ///< of directions in it, if it is chosen [1/sr]
    };
    InlineVector<Cone, HotSpots::kMost> cones_;
    double irradiance_ = 0; // of all cones
    double aimed_ = 0;
};

} // namespace keyhole
