// The way to OpenImageIO: a module that is loaded when a scene first needs it.
#include "core/error.h"
#include "scene/images/image.h"
#include "scene/images/oiio/read_image.h"

#include <fmt/format.h>

#include <dlfcn.h>

#include <array>
#include <filesystem>

namespace keyhole {
namespace {

/// Beside the program, one folder up (tests lie in one of their own), or where an installed program has it.
std::vector<std::filesystem::path> module_places() {
    Dl_info here;
    if (dladdr(reinterpret_cast<const void*>(&read_other_image), &here) == 0) return {};
    std::error_code error;
    const auto folder = std::filesystem::canonical(here.dli_fname, error).parent_path();
    constexpr std::array places{"", "..", "../lib/keyhole"};
    std::vector<std::filesystem::path> paths;
    paths.reserve(places.size());
    for (const char* place : places) paths.push_back(folder / place / kImageModule);
    return paths;
}

ReadImage* load_module() {
    std::string tried;
    for (const auto& path : module_places()) {
        if (void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL); module != nullptr) {
            if (void* symbol = dlsym(module, kReadImageSymbol); symbol != nullptr)
                return reinterpret_cast<ReadImage*>(symbol);
        }
        std::error_code error;
        // A module that is there and doesn't load tells more than those that are not.
        if (std::filesystem::exists(path, error)) throw InputError(fmt::format("OpenImageIO: {}", dlerror()));
        tried += ' ' + path.string();
    }
    throw InputError("images other than EXR, PFM, TGA and JPEG need the module with OpenImageIO, not found at" + tried);
}

} // namespace

TextureImage read_other_image(const std::string& path, ImagePart part) {
    static ReadImage* const read = load_module();
    TextureImage image;
    std::string error;
    if (!read(path, part, image, error)) {
        if (!error.starts_with("found"))
            error = fmt::format("found no image that can be read ({}), expected EXR, PFM, TGA, JPEG or one that "
                                "OpenImageIO reads, such as PNG",
                                error);
        throw InputError(path + ": " + error);
    }
    return image;
}

} // namespace keyhole
