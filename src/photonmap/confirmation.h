// Whether pilot photons confirm what main photons show.
#pragma once

#include "photonmap/piloted_map.h"

#include <vector>

namespace keyhole {

/// What lies in a small part of a lookup's region, a spot of a sixteenth of its area.
struct SpotOfRegion {
    static constexpr float kSize = 0.25f, kArea = kSize * kSize; // over the region's

    double light = 0, all = 0; ///< luminance that main photons bring there, and to the region
    double pilots = 0;         ///< share of the region's pilot photons

    /// Share [0, 1] of the region's light that is not there: where most of it lies in the spot, and pilot photons are
    /// less dense there than a caustic's would be. It came by a single photon of large power, or by the many that a
    /// chain leaves which stays near one path. 0 where light is spread, and where pilot photons confirm it.
    double unconfirmed() const {
        const double share = all > 0 ? light / all : 0;
        return share > 0.5 && pilots < share / 4 ? share : 0;
    }
};

/// The spot around `middle` in a region of radius `r` [m]. `light(photon)`: the luminance that a main photon brings.
template <class Light>
SpotOfRegion spot_of_region(const PilotedMap& map, const SurfaceRegion& region, float r, const Vec3& middle,
                            Light&& light) {
    const auto in_spot = [&](const Photon& p) {
        return (p.position() - middle).length2() <= SpotOfRegion::kArea * r * r;
    };
    SpotOfRegion spot;
    map.main_photons().for_each_within(region, r, [&](const Photon& photon) {
        const double brought = light(photon);
        spot.all += brought;
        if (in_spot(photon)) spot.light += brought;
    });
    // One pilot photon more, spread over the region: without any, little is known.
    double pilots = 1, near = static_cast<double>(SpotOfRegion::kArea);
    map.pilots().for_each_within(region, r, [&](const Photon& pilot) {
        ++pilots;
        near += in_spot(pilot) ? 1 : 0;
    });
    spot.pilots = near / pilots;
    return spot;
}

/// SpotOfRegion::unconfirmed() of the spot with most of a region's light, which is seen as a disc as large as the
/// region.
template <class Light>
double unconfirmed_share(const PilotedMap& map, const SurfaceRegion& region, float r, Light&& light) {
    struct Part {
        Vec3 p;
        double light;
    };
    std::vector<Part> parts;
    double all = 0;
    map.main_photons().for_each_within(region, r, [&](const Photon& photon) {
        parts.push_back({photon.position(), light(photon)});
        all += parts.back().light;
    });
    if (!(all > 0)) return 0;
    // Photons that are close together follow each other in the tree: a spot with more than half of the light holds the
    // photon at which half of it is passed.
    double passed = 0;
    Vec3 middle(0.0f);
    for (const Part& part : parts) {
        middle = part.p;
        if ((passed += part.light) >= all / 2) break;
    }
    return spot_of_region(map, region, r, middle, light).unconfirmed();
}

} // namespace keyhole
