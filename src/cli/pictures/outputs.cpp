#include "cli/pictures/outputs.h"

#include "core/error.h"
#include "core/parallel.h"
#include "film/denoise/denoise.h"
#include "film/files/atomic_file.h"
#include "film/files/exr.h"
#include "film/files/png.h"
#include "session/stage_clock.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <utility>

namespace keyhole {
namespace {

constexpr Stage kDenoising{"denoising"};

/// Of the time of a render that is short for its size: a filter of a shorter reach takes less.
constexpr double kMostOfTime = 0.3;
/// Who interrupts a render waits no longer for it [s].
constexpr double kPatience = 0.25;

} // namespace

Denoising::Denoising(Denoise what, bool png, std::size_t pixels, int threads)
    : pixels_(pixels), threads_(busy_cores(threads)),
      reach_(what == Denoise::exr || (what == Denoise::png && png) ? kDenoisingReach : 0) {}

double Denoising::reserve_of_cpu_time(double seconds) {
    if (reach_ > 0) reach_ = denoising_reach(pixels_, kMostOfTime * seconds);
    return reach_ > 0 ? denoising_seconds(pixels_, reach_) : 0;
}

std::optional<Image> Denoising::apply(const Picture& picture, const StopToken& stop, RenderStats& stats) const {
    const bool interrupted = stop.requested();
    int reach = reach_;
    if (interrupted && reach > 0) reach = std::min(reach, denoising_reach(pixels_, kPatience * threads_));
    if (reach == 0) return std::nullopt;
    const StageClock clock(stats, kDenoising);
    std::optional<Image> image;
    try {
        with_threads(threads_, [&] { image = denoise(picture, reach, interrupted ? nullptr : &stop); });
    } catch (const std::bad_alloc&) { // the picture itself is worth more
    }
    return image;
}

namespace fs = std::filesystem;

namespace {

/// Where a filter takes longer than one likes to lose a picture for, the EXR is written before it, too.
constexpr std::size_t kPixelsOfASecond = 400'000;

} // namespace

std::string default_exr(const std::string& scene) { return fs::path(scene).stem().string() + ".exr"; }

std::string default_png(const std::string& exr) { return fs::path(exr).replace_extension(".png").string(); }

void Outputs::check() const {
    // The folder's faults come first: they are what -o DIRECTORY runs into.
    check_writable(exr);
    if (fs::path(exr).extension() != ".exr") throw InputError(exr + ": expected a name that ends in .exr");
    if (!png.empty()) check_writable(png);
    if (!stats.empty()) check_writable(stats);
}

std::vector<NamedFile> Outputs::files() const {
    return {{"the picture", exr}, {"the tone-mapped picture", png}, {"--stats", stats}};
}

void Outputs::write(Picture picture, const Filter& filter, const std::function<std::string()>& stats_json) const {
    std::map<std::string, Image> noise;
    if (!noise_layers) noise = take_noise_layers(picture);
    const auto filtered = [&] {
        picture.layers.merge(noise);
        std::optional<Image> image = filter(picture);
        if (!noise_layers) erase_noise_layers(picture);
        return image;
    };
    if (denoise != Denoise::exr || picture.layers.at("beauty").pixels() > kPixelsOfASecond) write_exr(exr, picture);
    if (denoise == Denoise::exr) {
        if (std::optional<Image> image = filtered())
            picture.layers["unfiltered"] = std::exchange(picture.layers.at("beauty"), *std::move(image));
        write_exr(exr, picture);
    }
    if (!png.empty()) {
        const std::optional<Image> image = denoise == Denoise::png ? filtered() : std::nullopt;
        write_png(png, image ? *image : picture.layers.at("beauty"), exposure);
    }
    if (!stats.empty()) write_file_atomically(stats, stats_json());
}

} // namespace keyhole
