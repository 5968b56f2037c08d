#include "film/denoise/denoise.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/vec.h"
#include "film/denoise/nonlocal_means.h"
#include "film/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace keyhole {
namespace {

float luminance_at(const Image& image, int x, int y) {
    const float* p = image.at(x, y);
    return static_cast<float>(luminance(Rgb(p[0], p[1], p[2])));
}

/// Multiplies by a power of two.
void scale(Image& image, int exponent) {
    for (float& v : image.data) v = std::ldexp(v, exponent);
}

/// Pixels around one over which its noise is averaged, and over which the filter is judged.
constexpr int kReachOfNoise = 2, kReachOfJudgement = 3;
/// And over which that of a pixel of one sample is: of its neighbours, one in sixteen may have another.
constexpr int kReachOfSingle = 6;

/// Pixels that have one sample: something is seen there, and in no layer does a half differ from the other. Two samples
/// meet no surface at the same distance; where nothing is seen, an even background has no noise.
std::vector<bool> pixels_of_one_sample(const Picture& picture) {
    const std::vector<float>& depth = picture.layers.at("depth").data;
    std::vector<bool> single(depth.size());
    std::transform(depth.begin(), depth.end(), single.begin(), [](float z) { return z > 0; });
    for (const auto& [name, image] : picture.layers) {
        if (!name.starts_with(noise_layer({}))) continue;
        for (std::size_t i = 0; i < image.data.size(); ++i)
            if (image.data[i] != 0) single[i / static_cast<std::size_t>(image.channels)] = false;
    }
    return single;
}

/// The sum of some layers of three channels, and of their noise.
struct FilterPart {
    Image mean, noise;
    const std::vector<bool>& single; ///< by pixel: of one sample

    /// `of_one_sample` must outlive it.
    FilterPart(const Picture& picture, std::initializer_list<const char*> layers,
               const std::vector<bool>& of_one_sample)
        : mean(picture.width, picture.height, 3), noise(mean), single(of_one_sample) {
        for (const std::string layer : layers) {
            add(picture.layers.at(layer), mean);
            add(picture.layers.at(noise_layer(layer)), noise);
        }
    }

    /// Gives pixels of one sample halves that differ as much as those of their neighbours would: who stopped a render
    /// in the middle of a round of samples shall not see where.
    void assume_noise_of_single() {
        const Image known = noise;
        parallel_for(noise.height, [&](std::int64_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < noise.width; ++x) {
                if (!is_single(x, y)) continue;
                // That of neighbours is of two samples.
                const Rgb squares = mean_square(known, x, y) * 2.0;
                // By chance, so that pixels seem alike on average.
                const bool up = Rng(0, StreamPurpose::filter, index(x, y)).next() < 0.5;
                for (int c = 0; c < 3; ++c)
                    noise.at(x, y)[c] = static_cast<float>((up ? 1 : -1) * std::sqrt(squares[c]));
            }
        });
    }

    bool is_single(int x, int y) const { return single[index(x, y)]; }

    /// Brings its mean near 1, so that squares are numbers, whatever the unit of light. Returns the exponent of the
    /// power of two that it was.
    int normalise() {
        double sum = 0;
        for (const float v : mean.data) sum += std::abs(double{v});
        int exponent = 0;
        std::frexp(sum / static_cast<double>(mean.data.size()), &exponent);
        scale(mean, -exponent);
        scale(noise, -exponent);
        return exponent;
    }

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(mean.width) + static_cast<std::size_t>(x);
    }
    /// Over pixels near (x, y) that have more than one sample; 0 without any.
    Rgb mean_square(const Image& noise, int x, int y) const {
        Rgb sum(0.0);
        int count = 0;
        for (int j = std::max(0, y - kReachOfSingle); j <= std::min(noise.height - 1, y + kReachOfSingle); ++j)
            for (int i = std::max(0, x - kReachOfSingle); i <= std::min(noise.width - 1, x + kReachOfSingle); ++i) {
                if (is_single(i, j)) continue;
                const float* p = noise.at(i, j);
                sum += Rgb(p[0], p[1], p[2]) * Rgb(p[0], p[1], p[2]);
                ++count;
            }
        return count > 0 ? sum / count : sum;
    }
    static void add(const Image& layer, Image& sum) {
        std::ranges::transform(layer.data, sum.data, sum.data.begin(), std::plus());
    }
};

/// A pixel that a filter would make larger instead of less noisy.
struct Outlier {
    int x, y;
    std::array<float, 3> mean; ///< that it had
    bool confirmed;            ///< both halves of the samples have it
};

/// Of what all pixels of a window have, what one may have. Spread by nearness it adds half of what its neighbours have.
constexpr float kMostAdded = 0.2f;
/// So many times the mean over a window, itself among it, no outlier is below. And no more than so many of a window.
constexpr float kFarAboveMean = 8;
constexpr std::size_t kMostOfWindow = 6;
/// Of its brightness, what the half with less of it has at least: light that is there, not one sample's luck.
constexpr float kLeastInHalf = 0.1f;

/// The mean luminance of a window around (x, y) without its brightest pixels. `window` receives all of it.
float mean_of_most(const Plane& luminance, int x, int y, int reach, std::vector<float>& window) {
    window.clear();
    for (int j = std::max(0, y - reach); j <= std::min(luminance.height() - 1, y + reach); ++j)
        for (int i = std::max(0, x - reach); i <= std::min(luminance.width() - 1, x + reach); ++i)
            window.push_back(luminance(i, j));
    const std::size_t kept = window.size() - std::min(kMostOfWindow, window.size() - 1);
    std::ranges::nth_element(window, window.begin() + static_cast<std::ptrdiff_t>(kept - 1));
    double sum = 0;
    for (std::size_t i = 0; i < kept; ++i) sum += window[i];
    return static_cast<float>(sum / static_cast<double>(kept));
}

/// Finds pixels so bright that each, spread over those within `reach`, would make a disc of half their brightness more:
/// a lamp smaller than a pixel, or a sample out of thousands. Puts the mean of the others into their place, without
/// noise.
std::vector<Outlier> take_out_outliers(FilterPart& part, int reach) {
    const int width = part.mean.width, height = part.mean.height;
    const Plane luminance(width, height, 0, [&](int x, int y) { return luminance_at(part.mean, x, y); });
    const Plane mean = box_mean(width, height, 0, reach, luminance);
    std::vector<Outlier> found;
    std::vector<float> window;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float light = luminance(x, y);
            if (light <= kFarAboveMean * mean(x, y)) continue;
            const float rest = mean_of_most(luminance, x, y, reach, window);
            if (light <= kMostAdded * rest * static_cast<float>(window.size())) continue;
            float *p = part.mean.at(x, y), *noise = part.noise.at(x, y);
            const bool confirmed =
                !part.is_single(x, y) && std::abs(luminance_at(part.noise, x, y)) < (1 - kLeastInHalf) * light;
            found.push_back({x, y, {p[0], p[1], p[2]}, confirmed});
            for (int c = 0; c < 3; ++c) p[c] *= rest / light;
            std::fill_n(noise, 3, 0.0f);
        }
    }
    return found;
}

/// Of the square of the mean: as everywhere, what is darker has no relative error to speak of.
constexpr float kDark = 0.01f;

/// Of a filter of this reach, about; what is done for a pixel besides counts as ten.
double pixels_within(int reach) { return 3.14 * (reach + 0.5) * (reach + 0.5) + 10; }

float squared(float x) { return x * x; }

/// The mean of both filtered halves, blended with the part as it was.
Image judged(const FilterPart& part, const std::array<Image, 2>& smooth) {
    const int width = part.mean.width, height = part.mean.height;
    Image mean_of_both = smooth[0];
    std::ranges::transform(mean_of_both.data, smooth[1].data, mean_of_both.data.begin(),
                           [](float a, float b) { return (a + b) / 2; });
    // Either half is an unbiased judge of the other's filtered picture: its own variance, twice that of the mean of
    // both, is on top of the error. Errors are relative, so that what is bright and noisy doesn't speak for all around.
    double sum = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) sum += luminance_at(part.mean, x, y);
    const float dark = kDark * squared(static_cast<float>(sum / (width * height)));
    const auto unit = [&](int x, int y) {
        return squared(luminance_at(mean_of_both, x, y)) + dark + std::numeric_limits<float>::min();
    };
    // In all channels: what differs in colour alone has to stay, too.
    const auto squares = [](const float* a, const float* b, float sign_of_noise, const float* noise) {
        float sum = 0;
        for (int c = 0; c < 3; ++c) sum += squared(a[c] - (b[c] + sign_of_noise * noise[c]));
        return sum / 3;
    };
    constexpr std::array<float, 3> kBlack{};
    const Plane variance = box_mean(width, height, 0, kReachOfJudgement, [&](int x, int y) {
        return squares(kBlack.data(), kBlack.data(), 1, part.noise.at(x, y)) / unit(x, y);
    });
    const Plane distance = box_mean(width, height, 0, kReachOfJudgement, [&](int x, int y) {
        const float *mean = part.mean.at(x, y), *noise = part.noise.at(x, y);
        return (squares(smooth[0].at(x, y), mean, -1, noise) + squares(smooth[1].at(x, y), mean, 1, noise)) / 2 /
               unit(x, y);
    });
    Image result = part.mean;
    parallel_for(height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const float noise = 2 * variance(x, y), error = std::max(0.0f, distance(x, y) - noise);
            // Of the mean of two filtered halves half of the error of each is left, if it is noise: the weights of
            // least error are as 1 / variance.
            const float share = noise / (noise + error);
            if (!(share > 0)) continue; // without noise
            float* p = result.at(x, y);
            for (int c = 0; c < 3; ++c) p[c] = std::lerp(p[c], mean_of_both.at(x, y)[c], share);
        }
    });
    return result;
}

/// The part filtered, if it has noise that is known.
Image filtered(FilterPart part, const FilterGuides& guides, int reach, const StopToken* stop) {
    if (std::ranges::all_of(part.noise.data, [](float d) { return d == 0; })) return part.mean;
    const int exponent = part.normalise();
    part.assume_noise_of_single();
    const std::vector<Outlier> outliers = take_out_outliers(part, reach);
    const int width = part.mean.width, height = part.mean.height, border = reach + kPatch;
    const auto channel = [&](float sign, int c) {
        return Plane(width, height, border,
                     [&](int x, int y) { return part.mean.at(x, y)[c] + sign * part.noise.at(x, y)[c]; });
    };
    const auto half_luminance = [&](float sign) {
        return Plane(width, height, border, [&](int x, int y) {
            return luminance_at(part.mean, x, y) + sign * luminance_at(part.noise, x, y);
        });
    };
    const HalfPictures halves{
        {std::array{channel(1, 0), channel(1, 1), channel(1, 2)}, {channel(-1, 0), channel(-1, 1), channel(-1, 2)}},
        {half_luminance(1), half_luminance(-1)},
        box_mean(width, height, border, kReachOfNoise,
                 [&](int x, int y) { return 2 * squared(luminance_at(part.noise, x, y)); })};
    Image result = judged(part, filter_crosswise(halves, guides, reach, stop));
    for (const Outlier& o : outliers)
        if (o.confirmed) std::ranges::copy(o.mean, result.at(o.x, o.y));
    scale(result, exponent);
    return result;
}

/// CPU time by pixel and pixel within reach [s].
double seconds_of_trial() {
    constexpr int kSize = 64;
    Picture picture{kSize, kSize, {}, {}, {}};
    for (const char* layer : {"direct", "indirect", "caustic", "albedo", "normal"})
        for (const std::string& name : {std::string(layer), noise_layer(layer)})
            picture.layers[name] = Image(kSize, kSize, 3);
    picture.layers["depth"] = picture.layers[noise_layer("depth")] = Image(kSize, kSize, 1);
    for (const char* layer : {"noise.direct", "noise.indirect"}) std::ranges::fill(picture.layers[layer].data, 1.0f);
    const double start = cpu_seconds();
    denoise(picture, kDenoisingReach);
    return (cpu_seconds() - start) / (kSize * kSize) / pixels_within(kDenoisingReach);
}

} // namespace

std::optional<Image> denoise(const Picture& picture, int reach, const StopToken* stop) {
    for (const std::string layer : {"direct", "indirect", "caustic", "albedo", "normal", "depth"})
        if (!picture.layers.contains(layer) || !picture.layers.contains(noise_layer(layer))) return std::nullopt;
    const FilterGuides guides(picture, reach + kPatch);
    const std::vector<bool> single = pixels_of_one_sample(picture);
    Image sum = filtered(FilterPart(picture, {"direct"}, single), guides, reach, stop);
    const Image rest = filtered(FilterPart(picture, {"indirect", "caustic"}, single), guides, reach, stop);
    if (stop != nullptr && stop->requested()) return std::nullopt;
    std::ranges::transform(sum.data, rest.data, sum.data.begin(),
                           [](float a, float b) { return std::max(0.0f, a + b); });
    return sum;
}

double denoising_seconds(std::size_t pixels, int reach) {
    static const double of_pixel = seconds_of_trial();
    return of_pixel * static_cast<double>(pixels) * pixels_within(reach);
}

int denoising_reach(std::size_t pixels, double seconds) {
    int reach = kDenoisingReach;
    while (reach > 0 && denoising_seconds(pixels, reach) > seconds) --reach;
    return reach;
}

} // namespace keyhole
