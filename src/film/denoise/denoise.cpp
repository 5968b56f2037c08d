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
/// And over which noise is where fewer pixels than this have two samples: one in sixteen may, in the second round.
constexpr int kReachAmongSingle = 8;
constexpr float kFewestOfTwo = 16;

/// Which half of the samples has which pixel: a pixel of one sample is in one of them, by chance, so that either has
/// about as many.
struct HalvesSeen {
    std::array<Plane, 2> there; ///< what a pixel counts in a half: 1, or 2 and 0, so that all count the same in both
    bool whole;                 ///< no pixel has one sample

    bool both(int x, int y) const { return there[0](x, y) * there[1](x, y) > 0; }
};

/// Pixels that have one sample: something is seen there, and in no layer does a half differ from the other. Two samples
/// meet no surface at the same distance; where nothing is seen, an even background has no noise.
HalvesSeen halves_seen(const Picture& picture, int border) {
    const std::vector<float>& depth = picture.layers.at("depth").data;
    std::vector<bool> single(depth.size());
    std::transform(depth.begin(), depth.end(), single.begin(), [](float z) { return z > 0; });
    for (const auto& [name, image] : picture.layers) {
        if (!name.starts_with(noise_layer({}))) continue;
        for (std::size_t i = 0; i < image.data.size(); ++i)
            if (image.data[i] != 0) single[i / static_cast<std::size_t>(image.channels)] = false;
    }
    const auto there = [&](bool first) {
        return Plane(picture.width, picture.height, border, [&](int x, int y) {
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x);
            if (!single[i]) return 1.0f;
            return (Rng(0, StreamPurpose::filter, i).next() < 0.5) == first ? 2.0f : 0.0f;
        });
    };
    return {{there(true), there(false)}, std::ranges::count(single, true) == 0};
}

/// The mean of value(x, y) over the pixels of two samples within `reach`, or kReachAmongSingle where these are few; 0
/// without any.
template <class Value> Plane mean_of_two(const HalvesSeen& seen, int border, int reach, Value&& value) {
    const int width = seen.there[0].width(), height = seen.there[0].height();
    if (seen.whole) return box_mean(width, height, border, reach, value);
    const auto sums = [&](int within) {
        const auto share = [&](int x, int y) { return seen.both(x, y) ? 1.0f : 0.0f; };
        const auto term = [&](int x, int y) { return seen.both(x, y) ? value(x, y) : 0.0f; };
        return std::pair(box_mean(width, height, 0, within, term), box_mean(width, height, 0, within, share));
    };
    const auto near = sums(reach), far = sums(kReachAmongSingle);
    const float fewest = kFewestOfTwo / static_cast<float>((2 * reach + 1) * (2 * reach + 1));
    return {width, height, border, [&](int x, int y) {
                const auto& [sum, share] = near.second(x, y) >= fewest ? near : far;
                return share(x, y) > 0 ? sum(x, y) / share(x, y) : 0;
            }};
}

/// The sum of some layers of three channels, and of their noise.
struct FilterPart {
    Image mean, noise;

    FilterPart(const Picture& picture, std::initializer_list<const char*> layers)
        : mean(picture.width, picture.height, 3), noise(mean) {
        for (const std::string layer : layers) {
            add(picture.layers.at(layer), mean);
            add(picture.layers.at(noise_layer(layer)), noise);
        }
    }

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
std::vector<Outlier> take_out_outliers(FilterPart& part, const HalvesSeen& seen, int reach) {
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
                seen.both(x, y) && std::abs(luminance_at(part.noise, x, y)) < (1 - kLeastInHalf) * light;
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
Image judged(const FilterPart& part, const HalvesSeen& seen, const std::array<Image, 2>& smooth) {
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
    const Plane variance = mean_of_two(seen, 0, kReachOfJudgement, [&](int x, int y) {
        return squares(kBlack.data(), kBlack.data(), 1, part.noise.at(x, y)) / unit(x, y);
    });
    const Plane distance = mean_of_two(seen, 0, kReachOfJudgement, [&](int x, int y) {
        const float *mean = part.mean.at(x, y), *noise = part.noise.at(x, y);
        return (squares(smooth[0].at(x, y), mean, -1, noise) + squares(smooth[1].at(x, y), mean, 1, noise)) / 2 /
               unit(x, y);
    });
    Image result = part.mean;
    parallel_for(height, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const float noise = 2 * variance(x, y), error = std::max(0.0f, distance(x, y) - noise);
            // Of the mean of two filtered halves half of the error of each is left, if it is noise, as of the mean of
            // two samples; but not of one. The weights of least error are as 1 / variance.
            const float of_mean = seen.both(x, y) ? noise : 2 * noise;
            const float share = of_mean / (of_mean + error);
            if (!(share > 0)) continue; // without noise
            float* p = result.at(x, y);
            for (int c = 0; c < 3; ++c) p[c] = std::lerp(p[c], mean_of_both.at(x, y)[c], share);
        }
    });
    return result;
}

/// The part filtered, if it has noise that is known.
Image filtered(FilterPart part, const HalvesSeen& seen, const FilterGuides& guides, int reach, const StopToken* stop) {
    if (std::ranges::all_of(part.noise.data, [](float d) { return d == 0; })) return part.mean;
    const int exponent = part.normalise();
    const std::vector<Outlier> outliers = take_out_outliers(part, seen, reach);
    const int width = part.mean.width, height = part.mean.height, border = reach + kPatch;
    const auto channel = [&](std::size_t half, int c) {
        const float sign = half == 0 ? 1 : -1;
        return Plane(width, height, border, [&, sign, half, c](int x, int y) {
            return seen.there[half](x, y) * (part.mean.at(x, y)[c] + sign * part.noise.at(x, y)[c]);
        });
    };
    const auto half_luminance = [&](float sign) {
        return Plane(width, height, border, [&](int x, int y) {
            return luminance_at(part.mean, x, y) + sign * luminance_at(part.noise, x, y);
        });
    };
    const HalfPictures halves{
        seen.there,
        {std::array{channel(0, 0), channel(0, 1), channel(0, 2)}, {channel(1, 0), channel(1, 1), channel(1, 2)}},
        {half_luminance(1), half_luminance(-1)},
        mean_of_two(seen, border, kReachOfNoise,
                    [&](int x, int y) { return 2 * squared(luminance_at(part.noise, x, y)); })};
    Image result = judged(part, seen, filter_crosswise(halves, guides, reach, stop));
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
    const HalvesSeen seen = halves_seen(picture, reach + kPatch);
    Image sum = filtered(FilterPart(picture, {"direct"}), seen, guides, reach, stop);
    const Image rest = filtered(FilterPart(picture, {"indirect", "caustic"}), seen, guides, reach, stop);
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
