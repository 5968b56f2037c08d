#include "scene/images/image.h"

#include "core/bytes.h"
#include "core/error.h"
#include "core/files_read.h"
#include "scene/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <utility>

namespace keyhole {
namespace {

/// Images that somebody holds, by canonical path.
struct Cache {
    std::mutex mutex;
    std::map<std::pair<std::string, ImagePart>, std::weak_ptr<const TextureImage>> images;
    std::map<std::string, std::string> names; ///< by canonical path, of those that have one
    std::vector<std::weak_ptr<const LoadedImage>> pictures;
};

Cache& cache() {
    static Cache instance;
    return instance;
}

TextureImage read_image(const std::string& path, ImagePart part) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    if (extension == ".exr") return read_exr_image(path, part);
    if (extension == ".tga") return read_tga_image(path, part);
    const bool pfm = extension == ".pfm", jpeg = extension == ".jpg" || extension == ".jpeg";
    if (part == ImagePart::alpha && (pfm || jpeg)) return opaque_image();
    if (pfm) return read_pfm_image(path);
    if (jpeg) return read_jpeg_image(path);
    return read_other_image(path, part);
}

std::uint64_t content_hash(const TextureImage& image) {
    Hash hash;
    for (const int n : {image.width, image.height, image.channels}) hash.add(n);
    std::visit([&](const auto& texels) { hash.add(texels); }, image.texels);
    return hash.value();
}

std::shared_ptr<const TextureImage> read_with_hash(const std::string& path, ImagePart part) {
    TextureImage image = read_image(path, part);
    image.hash = content_hash(image); // once: scenes are asked for theirs several times
    return std::make_shared<const TextureImage>(std::move(image));
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

std::shared_ptr<const TextureImage> load_image(const std::string& path, ImagePart part) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(fmt::format("{}: found {}, expected an image", path, found_in_place_of_file(path)));
    const std::pair key{std::filesystem::weakly_canonical(path, error).string(), part};
    note_file_read(key.first);
    // Readers run one at a time: scenes have few images, and two threads must not decode the same one.
    const std::lock_guard lock(cache().mutex);
    auto& entry = cache().images[key];
    auto image = entry.lock();
    if (image == nullptr) entry = image = read_with_hash(path, part);
    return image;
}

std::vector<LoadedImage> loaded_images() {
    std::vector<LoadedImage> list;
    const std::lock_guard lock(cache().mutex);
    for (const auto& [key, entry] : cache().images)
        if (const auto image = entry.lock()) {
            const auto name = cache().names.find(key.first);
            list.push_back({name != cache().names.end() ? name->second : key.first, image->width, image->height,
                            image->channels, image->bytes(), image->hash});
        }
    return list;
}

void name_image(const std::string& path, const std::string& name) {
    std::error_code error;
    const std::lock_guard lock(cache().mutex);
    cache().names[std::filesystem::weakly_canonical(path, error).string()] = name;
}

std::vector<LoadedImage> loaded_pictures() {
    std::vector<LoadedImage> list;
    const std::lock_guard lock(cache().mutex);
    for (const auto& entry : cache().pictures)
        if (const auto picture = entry.lock()) list.push_back(*picture);
    return list;
}

std::shared_ptr<const LoadedImage> note_picture(LoadedImage picture) {
    std::error_code error;
    const auto whole = std::filesystem::absolute(picture.path, error);
    picture.path = std::filesystem::weakly_canonical(whole, error).string(); // as those of textures
    auto noted = std::make_shared<const LoadedImage>(std::move(picture));
    const std::lock_guard lock(cache().mutex);
    cache().pictures.emplace_back(noted);
    return noted;
}

} // namespace keyhole
