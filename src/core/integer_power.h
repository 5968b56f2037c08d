// Powers with whole exponents.
#pragma once

namespace keyhole {

/// x^n for n >= 0, by n products: for lengths of paths, which are small; std::pow() takes several times as long there.
constexpr double integer_power(double x, int n) {
    double y = 1;
    for (; n > 0; --n) y *= x;
    return y;
}

} // namespace keyhole
