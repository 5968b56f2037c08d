// The files that scenes were read from, so that no output replaces one of them.
#pragma once

#include <string>
#include <vector>

namespace keyhole {

/// Whoever opens a file of a scene notes it here. Thread-safe.
void note_file_read(const std::string& path);

/// All of them since this process began, by path. Thread-safe.
std::vector<std::string> files_read();

} // namespace keyhole
