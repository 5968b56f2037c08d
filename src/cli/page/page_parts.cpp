#include "cli/page/page_parts.h"

namespace keyhole {

std::string PageParts::with(std::string data) const {
    // A script element ends at the first "</".
    for (std::size_t at = 0; (at = data.find("</", at)) != std::string::npos;) data.replace(at, 2, "<\\/");
    return std::string(before_data) + data + std::string(after_data);
}

} // namespace keyhole
