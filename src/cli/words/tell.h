// Messages to whoever runs the program.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <utility>

namespace keyhole {

/// Formats a message and writes it to `out`. Where that fails, it is left out: that a log's disk is full, or its reader
/// gone, is no reason to lose a render.
template <class... Args> void tell_to(std::FILE* out, fmt::format_string<Args...> text, Args&&... args) {
    const std::string message = fmt::format(text, std::forward<Args>(args)...);
    std::fwrite(message.data(), 1, message.size(), out);
}

/// The same to stderr.
template <class... Args> void tell(fmt::format_string<Args...> text, Args&&... args) {
    tell_to(stderr, text, std::forward<Args>(args)...);
}

} // namespace keyhole
