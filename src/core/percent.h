// Shares for people.
#pragma once

#include <fmt/format.h>

#include <string>

namespace keyhole {

/// 0.0123 as "1.2 %", 0.123 as "12 %".
inline std::string percent(double share) {
    return share < 0.1 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

} // namespace keyhole
