// What a fuzzer makes up, as a file.
#pragma once

#include "core/error.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace keyhole {

/// Writes the bytes to a file of this process with such an extension. @returns its path.
inline std::string junk_file(const std::uint8_t* data, std::size_t size, const std::string& extension) {
    std::string path =
        (std::filesystem::temp_directory_path() / ("keyhole-fuzz-" + std::to_string(getpid()) + extension)).string();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    return path;
}

/// Calls `read`, which may throw InputError and nothing else.
template <class Read> int survive(Read&& read) {
    try {
        read();
    } catch (const InputError&) {
    }
    return 0;
}

} // namespace keyhole
