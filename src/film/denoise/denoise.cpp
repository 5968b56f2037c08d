#include "film/denoise/denoise.h"

#include "core/parallel.h"
#include "film/denoise/filter_part.h"
#include "film/denoise/nonlocal_means.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace keyhole {
namespace {

/// Pixels around one over which its noise is averaged, and over which the filter is judged.
constexpr int kReachOfNoise = 2, kReachOfJudgement = 3;
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
    Image sum = filtered(FilterPart(picture, {"direct"}), guides, reach, stop);
    const Image rest = filtered(FilterPart(picture, {"indirect", "caustic"}), guides, reach, stop);
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
