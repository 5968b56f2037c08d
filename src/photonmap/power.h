// The power of photons: every rule, and the factor that makes the sum of power over a region the flux that arrives
// there. docs/photon-maps.md compares the rules.
//
// A photon of a chain over whole paths x stands for paths drawn in proportion to Y(f(x)), of which the photon is to
// keep the light's side alone: f = f_map rest, and the camera sub-path has to be taken out of its power. Times B / N,
// where B is the integral of Y(f) and N the number of steps, the sum of power over a region is then the flux in it.
#pragma once

#include "photonmap/photon.h"
#include "sampling/paths/path.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace keyhole {

class Scene;

/// Power f_map / Y(f_map E), for weight 1: the photons that lie somewhere share f_map E, the integral over all eye
/// sides. Black where E says that nobody sees it.
inline Rgb marginal_power(const Rgb& flux, const Rgb& importance) {
    const double visible = luminance(flux * importance);
    return visible > 0 ? flux / visible : Rgb(0.0);
}

/// Power f_map * mean of q / Y(f) * n, for weight 1, where q is a density of camera sub-paths and n the number of draws
/// from it until one is valid: its expectation is the reciprocal of q's integral over those (Booth 2007; Zeltner et al.
/// 2020).
inline Rgb reciprocal_power(const Rgb& flux, double mean_density, std::int64_t draws) {
    return flux * (mean_density * static_cast<double>(draws));
}

/// Power f_map * mean of 1 / Y(f), for weight 1: MPS 3.2.
inline Rgb literal_power(const Rgb& flux, double mean_factor) { return flux * mean_factor; }

/// 1 / Y(flux * rest), where `rest` is what the contribution of a measured path has from vertex d2 on: the literal
/// factor of a photon of RGB `flux` at d2 (MPS 3.2). 0 where that isn't finite.
double literal_factor(const Path& path, int d2, const Rgb& flux);

/// Light that was drawn with density p as it was emitted and scattered: the walk carries its power f_map / p, and what
/// is stored with weight w has that over w.
inline Rgb emitted_power(const Rgb& carried, double weight) { return carried / weight; }

/// B / N of N steps of chains over whole paths: what the maps' power is multiplied by in the end.
inline double path_chain_scale(double brightness, double steps) { return brightness / steps; }
/// The literal rule leaves a scale open: that which makes the photons as visible as the paths were, where `weight` is
/// theirs and `visible` the sum of Y(power E) over them.
inline double literal_scale(double path_chain_scale, double weight, double visible) {
    return visible > 0 ? path_chain_scale * weight / visible : path_chain_scale;
}
/// Unit of the power that photons have before their map's scale: a power of two near the scene's cross-section, which
/// is of the size of 1 / E. In this unit it fits the format of photons, however large the scene is.
double unit_of_power(const Scene& scene);
/// 1 / N of N light paths.
inline double emission_scale(std::int64_t light_paths) { return 1 / static_cast<double>(light_paths); }

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
