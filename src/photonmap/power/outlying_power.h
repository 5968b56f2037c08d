// Photons of immense power: where hardly anybody looks, those that stand for what chains rarely visit.
#pragma once

#include "photonmap/photon.h"

#include <cmath>
#include <vector>

namespace keyhole {

/// What one of n samples of that mean may amount to: with a heavy tail their mean is nearest to the truth where they
/// are cut off at about the root of n times the mean (Catoni 2012); with more of them, nothing is.
inline double outlier_bound(double mean, double n) {
    constexpr double kOutlier = 2; // times the root of their number and their mean
    return kOutlier * mean * std::sqrt(n);
}

/// Cuts the power of outliers down to outlier_bound() of the others. Their hue stays. Chains leave photons of one
/// visible power, so that those where next to nobody looks have the more of their own; where a gather ray does meet
/// one, it outshines a record's other rays. A photon that loses all stands for 1/n of the visible power.
/// @returns the share of the power that was lost
double cut_outlying_power(std::vector<Photon>& photons);

} // namespace keyhole
