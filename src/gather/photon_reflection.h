// What a surface scatters of the light that a photon near it brought.
#pragma once

#include "photonmap/photon.h"
#include "sampling/paths/lamps_in_lobes.h"
#include "sampling/paths/path.h"

#include <algorithm>
#include <cmath>

namespace keyhole {

/// Least cosine at which a photon is taken to have arrived: its normal is known to half a degree.
constexpr double kLeastArrival = 0.05;

/// The weight of photons in radiance that the finite part at `v` scatters towards the unit direction `back` [1/sr]: the
/// BSDF, and with shading normals what they make of the cosine (Veach 1997, 5.3). The flux of a photon has the cosine
/// of the surface that it fell on. Where `v` is on another facet of a smooth mesh, that of `v` may be next to nothing
/// for a photon that fell on its own nearly upright, and the weight would be a speck.
///
/// In a pane of ground glass what arrived at one face from outside lies so near to what arrives at the other one from
/// inside, on the same side of both, that only the sides of their surfaces tell them apart.
class PhotonReflection {
  public:
    /// @param longer by how many vertices the way on to the eye is longer than the shortest: see Photon::spare()
    PhotonReflection(const Vertex& v, const Vec3& back, int longer)
        : v_(v), back_(back), longer_(longer), through_(v.bsdf.traits().through) {}

    /// Of photons of the caustic map at a visible point: without what gather rays of a narrow lobe find.
    static PhotonReflection of_caustics(const Vertex& v, const Vec3& back, int longer) {
        PhotonReflection reflection(v, back, longer);
        reflection.lamps_by_rays_ = is_narrow(v.bsdf.glossy_part(), back);
        return reflection;
    }

    Rgb operator()(const Photon& photon) const {
        if (!photon.reaches(longer_)) return Rgb(0.0);
        const Vec3 normal = photon.normal().decode(), w = photon.direction();
        if (through_ && photon.behind() != (normal.dot(v_.point.ng) < 0)) return Rgb(0.0);
        Rgb f = v_.bsdf.finite(w, back_).value;
        if (lamps_by_rays_ && photon.caustic() && !is_black(f))
            f = v_.bsdf.diffuse_reflectance(back_) * v_.bsdf.diffuse_weight(w);
        const Vec3 shading = v_.bsdf.shading_normal();
        if (shading == v_.point.ng || shading == -v_.point.ng) return f;
        const double arrival = std::max(kLeastArrival, std::abs(static_cast<double>(normal.dot(w))));
        return f * (std::abs(static_cast<double>(shading.dot(w))) / arrival);
    }

  private:
    const Vertex& v_;
    Vec3 back_;
    int longer_;
    bool through_;
    bool lamps_by_rays_ = false;
};

} // namespace keyhole
