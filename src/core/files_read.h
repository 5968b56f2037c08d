// The files that scenes are read from: they are noted, so that no output replaces one of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace keyhole {

/// What errors say was found where a file is to be: nothing, or what is none.
std::string_view found_in_place_of_file(const std::string& path);

/// Whoever opens a file of a scene notes it here. Thread-safe.
void note_file_read(const std::string& path);

/// All of them since this process began, by path. Thread-safe.
std::vector<std::string> files_read();

} // namespace keyhole
