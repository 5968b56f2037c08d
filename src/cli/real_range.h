// Checks of numbers on the command line.
#pragma once

#include <CLI/CLI.hpp>

#include <cmath>

namespace keyhole {

/// A number from `least` to `most`; "nan" is none, which CLI::Range lets pass.
inline CLI::Validator real_range(double least, double most) {
    CLI::Validator range = CLI::Range(least, most);
    const auto number = CLI::Validator(
        [](const std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && std::isnan(value) ? "found nan, expected a number"
                                                                               : std::string();
        },
        "");
    return range & number;
}

} // namespace keyhole
