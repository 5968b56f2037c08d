// Whether pilot photons confirm what main photons show.
#pragma once

#include "photonmap/piloted_map.h"

#include <vector>

namespace keyhole {

/// Share [0, 1] of the light of a lookup over `region` of radius `r` [m] that lies in a small part of it, where pilot
/// photons don't confirm that it is so bright: a single photon of large power, or the many that a chain leaves which
/// stays near one path. It lights the whole region, and is seen as a disc. 0 where light is spread, and where pilot
/// photons are as dense in the bright part as a caustic's would be. `light(photon)`: the luminance that a main photon
/// brings.
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
    constexpr float kSize = 0.25f, kArea = kSize * kSize; // of the spot over the region's
    const auto in_spot = [&](const Vec3& p) { return (p - middle).length2() <= kArea * r * r; };
    double bright = 0;
    for (const Part& part : parts) bright += in_spot(part.p) ? part.light : 0;
    // One pilot photon more, spread over the region: without any, little is known.
    double pilots = 1, near = static_cast<double>(kArea);
    map.pilots().for_each_within(region, r, [&](const Photon& pilot) {
        ++pilots;
        near += in_spot(pilot.position()) ? 1 : 0;
    });
    const double share = bright / all;
    return share > 0.5 && near / pilots < share / 4 ? share : 0;
}

} // namespace keyhole
