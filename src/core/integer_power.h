// Powers with whole exponents.
#pragma once

#include <cmath>

namespace keyhole {

/// x^n for n >= 0, by n products: for lengths of paths, which are small; std::pow() takes several times as long there.
constexpr double integer_power(double x, int n) {
    double y = 1;
    for (; n > 0; --n) y *= x;
    return y;
}

/// The power of two nearest to x > 0 by ratio, as a unit that costs no rounding; 1 for what isn't positive.
inline double power_of_two_near(double x) { return x > 0 ? std::exp2(std::round(std::log2(x))) : 1; }

} // namespace keyhole
