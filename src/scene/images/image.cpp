#include "scene/images/image.h"

#include "core/error.h"
#include "scene/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>

namespace keyhole {
namespace {

/// Images that somebody holds, by canonical path.
struct Cache {
    std::mutex mutex;
    std::map<std::string, std::weak_ptr<const TextureImage>> images;
};

Cache& cache() {
    static Cache instance;
    return instance;
}

TextureImage read_image(const std::string& path) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    if (extension == ".exr") return read_exr_image(path);
    if (extension == ".pfm") return read_pfm_image(path);
    if (extension == ".tga") return read_tga_image(path);
    if (extension == ".jpg" || extension == ".jpeg") return read_jpeg_image(path);
    return read_other_image(path);
}

} // namespace

std::size_t TextureImage::bytes() const {
    return std::visit([](const auto& t) { return t.size() * sizeof(t[0]); }, texels);
}

void check_image_size(const std::string& path, std::int64_t width, std::int64_t height) {
    if (width >= 1 && height >= 1 && width <= kMaxImageSide && height <= kMaxImageSide &&
        width * height <= kMaxImagePixels)
        return;
    throw InputError(fmt::format("{}: found an image of {} x {} pixels, expected 1 to {} each and at most {} together",
                                 path, width, height, kMaxImageSide, kMaxImagePixels));
}

std::shared_ptr<const TextureImage> load_image(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(fmt::format("{}: found no such file, expected an image", path));
    const std::string key = std::filesystem::weakly_canonical(path, error).string();
    // Readers run one at a time: scenes have few images, and two threads must not decode the same one.
    const std::lock_guard lock(cache().mutex);
    auto& entry = cache().images[key];
    auto image = entry.lock();
    if (image == nullptr) entry = image = std::make_shared<const TextureImage>(read_image(path));
    return image;
}

std::vector<LoadedImage> loaded_images() {
    std::vector<LoadedImage> list;
    const std::lock_guard lock(cache().mutex);
    for (const auto& [path, entry] : cache().images)
        if (const auto image = entry.lock())
            list.push_back({path, image->width, image->height, image->channels, image->bytes()});
    return list;
}

} // namespace keyhole
