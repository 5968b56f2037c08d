#include "support/chi_squared.h"

#include "scene/warp.h"

#include <array>
#include <cmath>

namespace keyhole::test {
namespace {

/// Nodes and weights of Gauss and Legendre's rule with 5 points on [0,1].
constexpr std::array<double, 5> kNodes{0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842, 0.953089922969332};
constexpr std::array<double, 5> kWeights{0.118463442528095, 0.239314335249683, 0.284444444444444, 0.239314335249683,
                                         0.118463442528095};

constexpr int kLevels = 7;

using F2 = std::function<double(double, double)>;

double gauss(const F2& f, double x0, double x1, double y0, double y1) {
    double sum = 0;
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 5; ++j)
            sum += kWeights[i] * kWeights[j] * f(x0 + kNodes[i] * (x1 - x0), y0 + kNodes[j] * (y1 - y0));
    return sum * (x1 - x0) * (y1 - y0);
}

double refine(const F2& f, double x0, double x1, double y0, double y1, double whole, double tolerance, int depth) {
    const double xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
    const std::array parts{gauss(f, x0, xm, y0, ym), gauss(f, xm, x1, y0, ym), gauss(f, x0, xm, ym, y1),
                           gauss(f, xm, x1, ym, y1)};
    const double sum = parts[0] + parts[1] + parts[2] + parts[3];
    // Two levels at least, lest a narrow peak hide between the points.
    if (depth == 0 || (depth < kLevels - 1 && std::abs(sum - whole) < tolerance)) return sum;
    const double t = tolerance / 2;
    return refine(f, x0, xm, y0, ym, parts[0], t, depth - 1) + refine(f, xm, x1, y0, ym, parts[1], t, depth - 1) +
           refine(f, x0, xm, ym, y1, parts[2], t, depth - 1) + refine(f, xm, x1, ym, y1, parts[3], t, depth - 1);
}

/// Upper regularised incomplete gamma function Q(a, x) (Abramowitz and Stegun 6.5.29 and 6.5.31).
double gamma_q(double a, double x) {
    if (x <= 0) return 1;
    const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 10000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
        return 1 - sum * scale;
    }
    // Lentz's evaluation of the continued fraction.
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int n = 1; n < 10000; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (std::abs(d * c - 1) < 1e-15) break;
    }
    return h * scale;
}

/// Position of a local direction in the unit square of (cosine, azimuth).
std::array<double, 2> square_of(const Vec3& w) {
    const double phi = std::atan2(static_cast<double>(w.y), static_cast<double>(w.x)) / (2 * kPi);
    return {(static_cast<double>(w.z) + 1) / 2, phi < 0 ? phi + 1 : phi};
}

std::size_t cell_of(double x, int n) { return static_cast<std::size_t>(std::clamp(static_cast<int>(x * n), 0, n - 1)); }

} // namespace

double chi_squared_p_value(double statistic, double degrees_of_freedom) {
    return gamma_q(degrees_of_freedom / 2, statistic / 2);
}

double Histogram::p_value(double pool) const {
    double statistic = 0, pooled_observed = 0, pooled_expected = 0;
    int cells = 0;
    const auto add = [&](double o, double e) {
        statistic += (o - e) * (o - e) / e;
        ++cells;
    };
    for (std::size_t i = 0; i < observed.size(); ++i) {
        if (expected[i] >= pool) {
            add(observed[i], expected[i]);
        } else {
            pooled_observed += observed[i];
            pooled_expected += expected[i];
        }
    }
    if (pooled_expected >= pool) {
        add(pooled_observed, pooled_expected);
    } else if (pooled_observed > pooled_expected + 6 * std::sqrt(pooled_expected) + 6) {
        return 0;
    }
    return cells < 2 ? 1.0 : chi_squared_p_value(statistic, cells - 1);
}

Histogram direction_histogram(const DirectionSampler& sample, const DirectionDensity& density, std::uint64_t stream,
                              const SphereTest& test) {
    const auto cells = static_cast<std::size_t>(test.cosines * test.angles);
    Histogram h{std::vector<double>(cells + 1), std::vector<double>(cells + 1)};
    Rng rng(11, StreamPurpose::test, stream);
    for (int i = 0; i < test.samples; ++i) {
        const auto w = sample(rng);
        if (!w) {
            h.observed[cells] += 1;
            continue;
        }
        const auto [x, y] = square_of(test.frame.to_local(*w));
        h.observed[cell_of(x, test.cosines) * static_cast<std::size_t>(test.angles) + cell_of(y, test.angles)] += 1;
    }
    const F2 f = [&](double x, double y) {
        return 4 * kPi * density(test.frame.to_world(spherical(2 * x - 1, 2 * kPi * y)));
    };
    double sum = 0;
    for (int i = 0; i < test.cosines; ++i)
        for (int j = 0; j < test.angles; ++j) {
            const double x = test.cosines, y = test.angles;
            const double mass = integrate(f, i / x, (i + 1) / x, j / y, (j + 1) / y, 4e-6);
            h.expected[static_cast<std::size_t>(i * test.angles + j)] = mass * test.samples;
            sum += mass;
        }
    h.expected[cells] = std::max(0.0, 1 - sum) * test.samples;
    return h;
}

double integrate_sphere(const DirectionDensity& f, const Frame& frame) {
    double sum = 0;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j)
            sum += integrate(
                [&](double x, double y) { return 4 * kPi * f(frame.to_world(spherical(2 * x - 1, 2 * kPi * y))); },
                i / 8.0, (i + 1) / 8.0, j / 8.0, (j + 1) / 8.0, 1e-6);
    return sum;
}

double integrate(const std::function<double(double, double)>& f, double x0, double x1, double y0, double y1,
                 double tolerance) {
    return refine(f, x0, x1, y0, y1, gauss(f, x0, x1, y0, y1), tolerance, kLevels);
}

} // namespace keyhole::test
