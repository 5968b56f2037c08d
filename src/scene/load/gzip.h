// Files packed with gzip (RFC 1952).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace keyhole {

/// Whether bytes begin as a file packed with gzip does.
inline bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

/// What was packed: of a file of several parts all, one after the other. What follows the last part is passed over.
/// @throws InputError, without a position, for data that are broken or end too early, and for more than `most_bytes`.
std::string gunzip(std::string_view packed, std::size_t most_bytes);

} // namespace keyhole
