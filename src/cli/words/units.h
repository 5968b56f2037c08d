// Numbers for people.
#pragma once

#include <string>

namespace keyhole {

/// Three digits and an SI prefix: "1.23 M", "45.6 k", "789 ", "4.56 m".
std::string with_prefix(double x);

/// "3.2 s", "2 min 05 s", "1 h 02 min".
std::string duration(double seconds);

} // namespace keyhole
