// Files of a command that must not be one.
#pragma once

#include <string>
#include <vector>

namespace keyhole {

/// A file that a command reads or writes; without a path none.
struct NamedFile {
    std::string what; ///< as in "--stats"
    std::string path;
};

/// Those that a scene was read from: files_read().
std::vector<NamedFile> files_of_scene();

/// Compares files themselves, whatever they are called; what is no regular file, as /dev/null, may stand for several.
/// @throws InputError where an output would write over an input, or over another output.
void check_apart(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

} // namespace keyhole
