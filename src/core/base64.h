// Bytes as text (RFC 4648).
#pragma once

#include <string>
#include <string_view>

namespace keyhole {

std::string to_base64(std::string_view bytes);
/// Characters that are none, line ends for example, are passed over.
std::string from_base64(std::string_view text);

} // namespace keyhole
