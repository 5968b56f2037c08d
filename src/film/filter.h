// The reconstruction filter of the film.
#pragma once

#include "core/settings.h"
#include "core/vec.h"

#include <array>

namespace keyhole {

/// A separable filter that is nowhere negative and integrates to 1: a box, a triangle, or a Gaussian cut off at its
/// radius. The default is the Gaussian of Fan, Chenney and Lai (2005): width 2, sigma 1, in pixels. "Width" is read as
/// the full support, so that the filter reaches one pixel from its centre along either axis; cut off there, it has a
/// standard deviation of 0.54 pixels, about that of other renderers' default (0.5).
///
/// Paths are sampled by filter importance sampling (Ernst, Stamminger and Greiner 2006): every sample belongs to one
/// pixel and has weight 1, so that pixels share no noise and need no locks.
class PixelFilter {
  public:
    PixelFilter() : PixelFilter(Settings()) {}
    /// By `filter`, `filter_radius` and `filter_sigma`.
    explicit PixelFilter(const Settings& settings);

    /// How far it reaches from a pixel's centre along either axis [pixels].
    double radius() const { return radius_; }

    /// Offset from a pixel's centre [pixels], distributed as the filter, from two numbers in [0,1).
    Vec2 sample_offset(double u0, double u1) const;

    /// The filter at an offset from a pixel's centre, per pixel area; 0 outside its support. A sample drawn uniformly
    /// over the film weighs this much in each pixel that it splats to.
    double density(const Vec2& offset) const;
    /// Of its two factors, the one of an offset along one axis.
    double density_1d(double x) const;

  private:
    double sample_1d(double u) const;
    /// Of a Gaussian: what Newton's method adds to `x`, and what it ends at, to have `mass` of it up to that distance.
    double newton_step(double x, double mass) const;
    double quantile(double mass) const;

    FilterShape shape_;
    double radius_;
    double scale_ = 0, mass_ = 1;         // of a Gaussian: 1 / (sqrt(2) sigma), and its share within the radius
    std::array<double, 257> quantiles_{}; // of a Gaussian: distances of masses that are evenly spaced
};

} // namespace keyhole
