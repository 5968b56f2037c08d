// Sums over the photons of a region, from a few of them.
#pragma once

#include "core/rng.h"
#include "photonmap/photon_map.h"

#include <vector>

namespace keyhole {

/// Photons to sum over, and how many of them to ask.
struct FewOfRegion {
    const SurfaceRegion& region;
    float radius; ///< [m]
    int few;
};

/// Expectation: the sum of light(photon) over the photons of the region. Where there are more than `few`, so many are
/// drawn in proportion to importance(photon) >= 0, spread evenly over their order in the tree, in which neighbours
/// follow each other (systematic resampling), and only these are asked for their light: what that costs, a line of
/// sight or a lobe, is paid for them alone. `importance` must be positive wherever light is, and may ask maps for
/// what is nearest, but not for what is within a radius; `light` may ask anything.
template <class Importance, class Light>
Rgb sum_over_few(const PhotonMap& map, const FewOfRegion& of, const Importance& importance, const Light& light,
                 SampleSource& source) {
    struct Weighed {
        const Photon* photon;
        double importance;
    };
    thread_local std::vector<Weighed> weighed;
    weighed.clear();
    double all = 0;
    map.for_each_within(of.region, of.radius, [&](const Photon& photon) {
        const double i = importance(photon);
        if (!(i > 0)) return;
        weighed.push_back({&photon, i});
        all += i;
    });
    Rgb sum(0.0);
    if (weighed.size() <= static_cast<std::size_t>(of.few)) {
        for (const Weighed& w : weighed) sum += light(*w.photon);
        return sum;
    }
    const double step = all / of.few;
    double next = step * source.next(), passed = 0;
    for (const Weighed& w : weighed) {
        passed += w.importance;
        int drawn = 0;
        for (; next < passed; next += step) ++drawn;
        if (drawn > 0) sum += light(*w.photon) * (drawn * step / w.importance);
    }
    return sum;
}

} // namespace keyhole
