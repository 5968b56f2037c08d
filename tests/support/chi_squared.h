// Pearson's chi-squared test of sampling routines against their densities.
#pragma once

#include "core/rng.h"
#include "core/vec.h"
#include "support/chance.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace keyhole::test {

/// P(X >= statistic) for a chi-squared variable.
double chi_squared_p_value(double statistic, double degrees_of_freedom);

/// Counts of samples beside the numbers to expect. Cells with small expectations are pooled.
struct Histogram {
    std::vector<double> observed, expected;

    /// p-value of the observed counts. Cells that expect less than `pool` are put together; a pool that expects nearly
    /// nothing but holds samples gives 0.
    double p_value(double pool = 5) const;
};

/// Draws a direction; none where the routine drew nothing.
using DirectionSampler = std::function<std::optional<Vec3>(SampleSource&)>;
using DirectionDensity = std::function<double(const Vec3&)>;

struct SphereTest {
    int samples = 100'000;
    int cosines = 12, angles = 24; ///< cells: strips of equal area, cut by azimuth
    Frame frame{};                 ///< of the cells
};

/// Counts over cells of the sphere, and integrals of `density` over them by adaptive quadrature. A last cell holds what
/// was not drawn, and expects what `density` leaves of 1.
Histogram direction_histogram(const DirectionSampler& sample, const DirectionDensity& density, std::uint64_t stream,
                              const SphereTest& test = {});

/// Integral over the sphere of `f` by adaptive quadrature on cells around `frame`.
double integrate_sphere(const DirectionDensity& f, const Frame& frame = {});

/// Integral of f over [x0,x1] x [y0,y1], adaptively, to about `tolerance`.
double integrate(const std::function<double(double, double)>& f, double x0, double x1, double y0, double y1,
                 double tolerance = 1e-6);

} // namespace keyhole::test
