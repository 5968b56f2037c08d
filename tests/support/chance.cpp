#include "support/chance.h"

#include <algorithm>
#include <cmath>

namespace keyhole::test {
namespace {

/// Regularised incomplete beta function I_x(a, b) by its continued fraction (Lentz).
double incomplete_beta(double a, double b, double x) {
    if (x <= 0) return 0;
    if (x >= 1) return 1;
    if (x > (a + 1) / (a + b + 2)) return 1 - incomplete_beta(b, a, 1 - x);
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x)) / a;
    double f = 1, c = 1, d = 0;
    for (int i = 0; i <= 300; ++i) {
        const int m = i / 2;
        double numerator = 1;
        if (i > 0 && i % 2 == 0) numerator = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        if (i % 2 == 1) numerator = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / (1 + numerator * d);
        c = 1 + numerator / c;
        f *= c * d;
        if (std::abs(1 - c * d) < 1e-12) break;
    }
    return front * (f - 1);
}

} // namespace

double student_p_value(double t, double dof) {
    if (dof > 1e6) return std::erfc(std::abs(t) / std::sqrt(2.0));
    return incomplete_beta(dof / 2, 0.5, dof / (dof + t * t));
}

double sidak_threshold(int tests, double significance) { return 1 - std::pow(1 - significance, 1.0 / tests); }

double most_errors(int comparisons, double samples) {
    const double level = sidak_threshold(comparisons, kChance);
    double least = 0, most = 1e6;
    for (int i = 0; i < 64; ++i) {
        const double t = 0.5 * (least + most);
        (student_p_value(t, samples - 1) > level ? least : most) = t;
    }
    return most;
}

testing::AssertionResult has_mean(const RunningStats& found, double expected, int comparisons, double tolerance) {
    const double bound = most_errors(comparisons, static_cast<double>(found.count()));
    if (std::abs(found.mean() - expected) <= bound * found.standard_error() + tolerance)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << found.mean() << " +- " << found.standard_error() << ", expected " << expected
                                       << " within " << bound << " standard errors";
}

testing::AssertionResult same_mean(const RunningStats& a, const RunningStats& b, int comparisons) {
    // Welch's degrees of freedom.
    const double va = a.standard_error() * a.standard_error(), vb = b.standard_error() * b.standard_error();
    const double dof = (va + vb) * (va + vb) /
                       (va * va / static_cast<double>(a.count() - 1) + vb * vb / static_cast<double>(b.count() - 1));
    const double error = std::sqrt(va + vb);
    const double bound = va + vb > 0 ? most_errors(comparisons, dof + 1) : 0.0;
    if (std::abs(a.mean() - b.mean()) <= bound * error) return testing::AssertionSuccess();
    return testing::AssertionFailure() << a.mean() << " and " << b.mean() << " differ by more than " << bound
                                       << " standard errors of " << error;
}

} // namespace keyhole::test
