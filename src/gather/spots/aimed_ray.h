// A gather ray of a glossy lobe, aimed at hot spots.
#pragma once

#include "gather/spots/hot_spots.h"

#include <optional>
#include <vector>

namespace keyhole {

/// The second of two techniques for what a lobe reflects: the first draws from the lobe, and rarely meets a lampshade
/// that a wide one reflects. This one draws in the cones that spots fill, where these may be a good part of what is
/// seen. To be weighted against each other by the balance heuristic.
class AimedRay {
  public:
    /// @param spots null: there are none
    /// @param lobe of the BSDF at `v`, or all of that
    /// @param besides luminance that leaves `v` towards `back` besides what gather rays bring [W/(m^2 sr)]
    /// @param rays that are drawn from the lobe, on average
    AimedRay(const HotSpots* spots, const Vertex& v, const Bsdf& lobe, const Vec3& back, double besides, double rays);

    /// A direction; none where no ray is worth its time.
    std::optional<Vec3> sample(SampleSource& source) const;
    /// Rays of both techniques per solid angle [1/sr].
    /// @param pdf density with which the lobe draws `w`, per solid angle
    double density(const Vec3& w, double pdf) const;

  private:
    double rays_;
    std::vector<SpotCone> cones_;
    std::vector<double> chances_; // with which one is drawn in each cone
};

} // namespace keyhole
