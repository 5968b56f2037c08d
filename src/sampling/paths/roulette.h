// Russian roulette on walks (Arvo and Kirk 1990): every rule by which one is ended early. A walk that survives carries
// its throughput over the probability of that, so that no rule changes an expectation; what they trade is work for
// noise. The photon stores thin photons by their weights (photon_store.h), which is no matter of walks.
#pragma once

#include "core/rng.h"
#include "core/vec.h"

#include <algorithm>

namespace keyhole {

/// Walks from the eye, by the largest component of their throughput. It begins with the fifth scattering
/// (`scatterings`: those before): earlier ones matter most. At 0.95 no walk goes on for ever, at 0.05 none becomes an
/// outlier.
inline double eye_survival(const Rgb& throughput, int scatterings) {
    if (scatterings < 4) return 1;
    return std::clamp(std::max({throughput.x, throughput.y, throughput.z}), 0.05, 0.95);
}

/// Sub-paths that are to be joined, from either end, by the luminance of what is left of them since their start. Every
/// vertex costs connections, but one that is lost takes all of them with it: 0.1 at least. `vertices`: so far.
inline double subpath_survival(const Rgb& carried, std::size_t vertices) {
    if (vertices < 4) return 1;
    return std::clamp(luminance(carried), 0.1, 0.95);
}

/// Light that leaves photons: what survives keeps about `reference` [W], the luminance of what was emitted, so that
/// photons are alike (Jensen 2001, section 5.2); where directions were learned, that of what BSDFs would have made of
/// it.
inline double photon_survival(const Rgb& power, double reference) {
    return std::min(1.0, luminance(power) / reference);
}

/// Whether a walk survives what it does with probability `survival`; no number is drawn where that is certain. Its
/// throughput is divided by it.
inline bool play_roulette(double survival, Rgb& throughput, SampleSource& source) {
    if (!(survival < 1)) return true;
    if (source.next() >= survival) return false;
    throughput /= survival;
    return true;
}

} // namespace keyhole
