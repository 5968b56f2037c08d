#include "cli/words/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace keyhole {

std::string with_prefix(double x) {
    constexpr std::array<const char*, 8> kPrefixes{"n", "u", "m", "", "k", "M", "G", "T"};
    constexpr std::size_t kNone = 3;
    std::size_t k = kNone;
    // Less would print as 0.00.
    if (x != 0 && std::abs(x) < 0.01)
        for (; std::abs(x) < 1 && k > 0; --k) x *= 1000;
    // 999.5 and more would print as 1000.
    for (; std::abs(x) >= 999.5 && k + 1 < kPrefixes.size(); ++k) x /= 1000;
    const double size = std::abs(x);
    const int decimals = size >= 99.95 || (k == kNone && x == std::floor(x)) ? 0 : size >= 9.995 ? 1 : 2;
    return fmt::format("{:.{}f} {}", x, decimals, kPrefixes[k]);
}

std::string duration(double seconds) {
    if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<long long>(std::min(std::round(seconds), 1e15));
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

} // namespace keyhole
