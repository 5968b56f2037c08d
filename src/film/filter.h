// The reconstruction filter of the film.
#pragma once

#include "core/vec.h"

namespace keyhole {

/// The Gaussian of Fan, Chenney and Lai (2005): width 2, sigma 1, in pixels. "Width" is read as the full support, so
/// that the filter reaches one pixel from its centre along either axis; cut off there, it has a standard deviation of
/// 0.54 pixels, about that of other renderers' default (0.5). Separable; integrates to 1.
///
/// Paths are sampled by filter importance sampling (Ernst, Stamminger and Greiner 2006): every sample belongs to one
/// pixel and has weight 1, so that pixels share no noise and need no locks.
class GaussianFilter {
  public:
    static constexpr double kRadius = 1.0; ///< [pixels]
    static constexpr double kSigma = 1.0;  ///< [pixels]

    /// Offset from a pixel's centre [pixels], distributed as the filter, from two numbers in [0,1).
    Vec2 sample_offset(double u0, double u1) const;

    /// The filter at an offset from a pixel's centre, per pixel area; 0 outside its support. A sample drawn uniformly
    /// over the film weighs this much in each pixel that it splats to.
    double density(const Vec2& offset) const;
};

} // namespace keyhole
