// Kronecker sequences: the multiples of an irrational number modulo 1, which fill [0,1) evenly however many there are.
#pragma once

#include <array>
#include <cmath>

namespace keyhole {

/// Steps of Roberts' R2 sequence ("The unreasonable effectiveness of quasirandom sequences", 2018): the two dimensions
/// together fill the unit square evenly.
inline constexpr std::array<double, 2> kR2{0.7548776662466927, 0.5698402909980532};

/// Member `i` of the sequence with step `alpha` that starts at `shift`, in [0,1).
inline double kronecker(double shift, double i, double alpha) {
    const double x = shift + i * alpha;
    return x - std::floor(x);
}

} // namespace keyhole
