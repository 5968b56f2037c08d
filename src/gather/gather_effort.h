// How many gather rays a sample of a pixel should trace.
#pragma once

namespace keyhole {

/// Samples of pixels that trace `rays` gather rays each where their whole BSDF is gathered.
struct GatherEffort {
    double rays;
    double variance; ///< of a sample
    double cost;     ///< of a sample, in any unit
};

/// The number of rays for which variance times cost, which the squared error goes with at equal cost, is least, within
/// the range of those two that were tried. Variance goes as a + b / rays and cost as c + d rays, so that it is
/// sqrt(b c / (a d)).
double best_gather_rays(const GatherEffort& few, const GatherEffort& many);

} // namespace keyhole
