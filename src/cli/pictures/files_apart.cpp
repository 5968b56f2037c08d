#include "cli/pictures/files_apart.h"

#include "core/error.h"
#include "scene/texture.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace keyhole {
namespace {

namespace fs = std::filesystem;

bool same_file(const std::string& a, const std::string& b) {
    if (a.empty() || b.empty()) return false;
    std::error_code error;
    const fs::file_status there = fs::status(a, error);
    if (fs::exists(there) && !fs::is_regular_file(there)) return false;
    if (fs::equivalent(a, b, error)) return true; // links, if both are there
    const fs::path one = fs::weakly_canonical(a, error), other = fs::weakly_canonical(b, error);
    return !error && one == other;
}

} // namespace

std::vector<NamedFile> files_of(const LoadedScene& scene) {
    std::vector<NamedFile> files;
    for (const std::string& path : scene.files) files.push_back({"a file of the scene", path});
    for (const LoadedImage& image : loaded_images()) files.push_back({"a texture", image.path});
    return files;
}

void check_apart(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
    for (auto o = outputs.begin(); o != outputs.end(); ++o) {
        for (const NamedFile& input : inputs)
            if (same_file(o->path, input.path))
                throw InputError(fmt::format("{}: found it as {}, to be written, and as {}, which is read; expected "
                                             "another name for {}",
                                             o->path, o->what, input.what, o->what));
        for (auto other = outputs.begin(); other != o; ++other)
            if (same_file(o->path, other->path))
                throw InputError(fmt::format("{}: found one name for two outputs, {} and {}; expected different ones",
                                             o->path, other->what, o->what));
    }
}

} // namespace keyhole
