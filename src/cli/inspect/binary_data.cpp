#include "cli/inspect/binary_data.h"

#include "cli/page/data_uri.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <new>

namespace keyhole {

nlohmann::ordered_json BinaryData::json() const {
    uLongf size = compressBound(bytes_.size());
    std::string small(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(small.data()), &size, reinterpret_cast<const Bytef*>(bytes_.data()),
                  bytes_.size(), 9) != Z_OK)
        throw std::bad_alloc();
    small.resize(size);
    return {{"arrays", directory_}, {"deflated", base64(small)}};
}

std::uint16_t logarithmic(double value) {
    if (!(value > 0)) return 0;
    return static_cast<std::uint16_t>(std::clamp(std::lround(1024 * (std::log2(value) + 32)), 1L, 65535L));
}

} // namespace keyhole
