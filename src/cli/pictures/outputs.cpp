#include "cli/pictures/outputs.h"

#include "core/error.h"
#include "film/files/atomic_file.h"
#include "film/files/exr.h"
#include "film/files/png.h"

#include <filesystem>
#include <utility>

namespace keyhole {

namespace fs = std::filesystem;

std::string default_exr(const std::string& scene) { return fs::path(scene).stem().string() + ".exr"; }

std::string default_png(const std::string& exr) { return fs::path(exr).replace_extension(".png").string(); }

void Outputs::check() const {
    // The folder's faults come first: they are what -o DIRECTORY runs into.
    check_writable(exr);
    if (fs::path(exr).extension() != ".exr") throw InputError(exr + ": expected a name that ends in .exr");
    if (!png.empty()) check_writable(png);
    if (!stats.empty()) check_writable(stats);
    const auto place = [](const std::string& path) { return fs::weakly_canonical(path); };
    if ((!png.empty() && place(png) == place(exr)) || (!stats.empty() && place(stats) == place(exr)) ||
        (!png.empty() && !stats.empty() && place(png) == place(stats)))
        throw InputError(exr + ": found one name for two outputs, expected different ones");
}

void Outputs::write(Picture picture, std::optional<Image> filtered, const std::string& stats_json) const {
    if (!noise_layers) erase_noise_layers(picture);
    Image& beauty = picture.layers.at("beauty");
    if (filtered && denoise == Denoise::exr) {
        picture.layers["unfiltered"] = std::exchange(beauty, *std::move(filtered));
        filtered.reset();
    }
    write_exr(exr, picture);
    if (!png.empty()) write_png(png, filtered ? *filtered : beauty, exposure);
    if (!stats.empty()) write_file_atomically(stats, stats_json);
}

} // namespace keyhole
