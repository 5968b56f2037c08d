#include "cli/pictures/files_apart.h"

#include "core/error.h"
#include "core/files_read.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace keyhole {
namespace {

namespace fs = std::filesystem;

/// Whether a file may stand for several: no regular one, as /dev/null.
bool is_special(const std::string& path) {
    std::error_code error;
    const fs::file_status there = fs::status(path, error);
    return fs::exists(there) && !fs::is_regular_file(there);
}

/// Links are followed. What is not there yet goes by its name.
bool same_file(const std::string& a, const std::string& b) {
    std::error_code error, other_error;
    if (fs::equivalent(a, b, error)) return true;
    if (!error) return false; // both are there
    const fs::path one = fs::weakly_canonical(a, error), other = fs::weakly_canonical(b, other_error);
    return !error && !other_error && one == other;
}

} // namespace

std::vector<NamedFile> files_of_scene() {
    std::vector<NamedFile> files;
    for (const std::string& path : files_read()) files.push_back({"a file of the scene", path});
    return files;
}

void check_apart(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
    for (auto o = outputs.begin(); o != outputs.end(); ++o) {
        if (o->path.empty() || is_special(o->path)) continue;
        for (const NamedFile& input : inputs)
            if (!input.path.empty() && same_file(o->path, input.path))
                throw InputError(fmt::format("{}: found it as {}, to be written, and as {}, which is read; expected "
                                             "another name for {}",
                                             o->path, o->what, input.what, o->what));
        for (auto other = outputs.begin(); other != o; ++other)
            if (!other->path.empty() && same_file(o->path, other->path))
                throw InputError(fmt::format("{}: found one name for two outputs, {} and {}; expected different ones",
                                             o->path, other->what, o->what));
    }
}

} // namespace keyhole
