#include "methods/choice/trial_error.h"

#include "core/statistics.h"
#include "core/vec.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keyhole {
namespace {

constexpr int kBlock = 4;      // pixels, each way
constexpr int kParts = 4;      // of the picture, each way, in which light may be missing
constexpr int kSmooth = 1;     // pixels, each way: more than one, for its noise must not be what it is compared with
constexpr double kDark = 0.01; // squared mean of the picture, lamps in view left out, that is added to a pixel's square
// Share of the pixels, those with the largest errors, that are left out, as error measures of pictures do. These have
// several times the samples in a pixel: of bright ones that are rare, and in few pixels of a trial, they leave out
// less.
constexpr double kTrimmed = 0.01, kTrimmedOfRare = 0.0025;
// Share of the pixels, the brightest, that may show lamps, or be blurred with one.
constexpr double kLamps = 0.1;
// Share of the pixels in which bright, rare samples may be.
constexpr double kRareSamples = 0.05;
// Of the brightness that another method finds in most of the picture, what shows that a method finds its light.
constexpr double kFindsLight = 0.5;
// The same, below which it finds next to none, or in so few samples that most of its picture is dark.
constexpr double kFindsNothing = 0.2;
// Standard errors of both that two means differ by before light is missing: there are many parts to differ in.
constexpr double kStandardErrors = 3;
// Times what a block has in all, that a pixel may bring to it: brighter ones are dots.
constexpr double kBrightestPixel = 3;
// Standard errors that what dots bring differs by from none.
constexpr double kErrorsOfDots = 2;
constexpr double kMedianOfNormal = 0.6745; // of the amounts of normal deviates, over their standard deviation

static_assert(kBlock * kBlock == kTrialBlock);

using Values = std::vector<double>;

double mean(const Values& v) {
    return v.empty() ? 0 : std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}

double median(Values v) {
    const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::ranges::nth_element(v, middle);
    return *middle;
}

Values without_largest(Values v, std::size_t count) {
    std::ranges::sort(v);
    v.resize(v.size() - count);
    return v;
}
std::size_t count_of(double share, std::size_t count) {
    return static_cast<std::size_t>(std::ceil(share * static_cast<double>(count)));
}
Values without_largest(Values v, double share) {
    const std::size_t count = count_of(share, v.size());
    return without_largest(std::move(v), count);
}

/// Brightness of a picture without its brightest pixels: beside a lamp in view everything else would be dark.
double typical(const Values& picture) { return mean(without_largest(picture, kLamps)); }

/// A grid of numbers, row by row.
struct Grid {
    int width, height;
    Values values;

    double at(int x, int y) const {
        return values[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
    }
    /// Means over blocks; a rest at the border is left out, unless there is nothing else.
    Grid blocks(int across, int down) const {
        Grid b{std::max(1, width / across), std::max(1, height / down), {}};
        for (int y = 0; y < b.height; ++y)
            for (int x = 0; x < b.width; ++x) {
                double sum = 0;
                for (int j = 0; j < down; ++j)
                    for (int i = 0; i < across; ++i) sum += at(x * across + i, y * down + j);
                b.values.push_back(sum / (across * down));
            }
        return b;
    }
    /// Means over squares about each pixel.
    Grid smooth() const {
        Grid s{width, height, {}};
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                double sum = 0;
                for (int j = -kSmooth; j <= kSmooth; ++j)
                    for (int i = -kSmooth; i <= kSmooth; ++i) sum += at(x + i, y + j);
                s.values.push_back(sum / ((2 * kSmooth + 1) * (2 * kSmooth + 1)));
            }
        return s;
    }
};

template <class F> Grid combined(const Image& a, const Image& b, const F& f) {
    Grid g{a.width, a.height, {}};
    const auto finite = [](float v) { return std::isfinite(v) ? static_cast<double>(v) : 0.0; };
    for (std::size_t i = 0; i < a.data.size(); ++i) g.values.push_back(f(finite(a.data[i]), finite(b.data[i])));
    return g;
}
Grid grid_of(const Image& a) {
    return combined(a, a, [](double v, double /*v*/) { return v; });
}
Grid mean_of(const TrialPictures& m) {
    return combined(m.first, m.second, [](double a, double b) { return (a + b) / 2; });
}
Grid difference_of(const Image& a, const Image& b) {
    return combined(a, b, [](double x, double y) { return x - y; });
}
Grid difference_of(const TrialPictures& m) { return difference_of(m.first, m.second); }

/// What is added to the square of each pixel of a picture, so that errors are relative to it in its darkest ones. Where
/// fewer have any light than may show lamps, as in a dark room of which trials find a few dots, these alone count.
double least_square(const Grid& picture) {
    double usual = typical(picture.values);
    if (!(usual > 0)) {
        Values lit = picture.values;
        std::erase(lit, 0.0);
        usual = typical(lit);
    }
    return kDark * usual * usual;
}

/// Half the squared difference is the variance of one of two. Relative to `picture`; of pixels.
Values relative_variances(const Grid& difference, const Grid& picture) {
    const double dark = least_square(picture);
    Values v;
    for (std::size_t i = 0; i < difference.values.size(); ++i) {
        const double d = difference.values[i], p = picture.values[i];
        v.push_back(p * p + dark > 0 ? d * d / 2 / (p * p + dark) : 0);
    }
    return v;
}
/// Without so many of the pixels with light: where these are few, all of them would be left out, and no error either.
double relative_variance(const Grid& difference, const Grid& picture, double trimmed = kTrimmed) {
    const auto lit = picture.values.size() - static_cast<std::size_t>(std::ranges::count(picture.values, 0.0));
    return mean(without_largest(relative_variances(difference, picture), count_of(trimmed, lit)));
}

/// How bright the methods find most of the picture, over the one that finds it brightest. Where none finds light in
/// most of it, in how many pixels they find any: few, bright dots are not to stand for what others see everywhere.
Values brightness_of(std::span<const TrialPictures> methods) {
    Values brightness, lit;
    for (const TrialPictures& m : methods) {
        const Values v = mean_of(m).values;
        brightness.push_back(typical(v));
        lit.push_back(static_cast<double>(v.size()) - static_cast<double>(std::ranges::count(v, 0.0)));
    }
    if (!(std::ranges::max(brightness) > 0)) brightness = lit;
    const double brightest = std::ranges::max(brightness);
    for (double& b : brightness) b = brightest > 0 ? b / brightest : 1;
    return brightness;
}

/// The mean of all, each weighted by the reciprocal of its variance relative to itself. One that hardly finds anything
/// where others see light agrees with itself as well: it has no say.
Grid common_picture(std::span<const TrialPictures> methods, const Values& brightness) {
    Grid sum{methods[0].first.width, methods[0].first.height, Values(methods[0].first.data.size(), 0.0)};
    double weights = 0;
    for (std::size_t k = 0; k < methods.size(); ++k) {
        const TrialPictures& m = methods[k];
        const Grid own = mean_of(m);
        if (!(mean(own.values) > 0) || brightness[k] < kFindsLight) continue;
        const double weight = 1 / (relative_variance(difference_of(m), own.smooth()) + 1e-9);
        weights += weight;
        for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += weight * own.values[i];
    }
    for (double& v : sum.values) v /= weights > 0 ? weights : 1;
    return sum;
}

/// Means of the picture's parts, and what they may be off by.
struct Parts {
    Grid means, errors;
    explicit Parts(const TrialPictures& m) : means(part_means(mean_of(m))), errors(means) {
        const Grid d = difference_of(m);
        Grid squares = d;
        for (double& v : squares.values) v *= v;
        const int across = std::max(1, d.width / kParts), down = std::max(1, d.height / kParts);
        const Grid of_pixels = squares.blocks(across, down), of_parts = part_means(d);
        // By pixels, or, where neighbours err alike, by the parts themselves: two renders may agree by chance in one of
        // them, but hardly in half of them.
        Values relative;
        for (std::size_t i = 0; i < errors.values.size(); ++i)
            relative.push_back(means.values[i] > 0 ? std::abs(of_parts.values[i]) / means.values[i] : 0);
        const double usual = median(relative) / kMedianOfNormal;
        for (std::size_t i = 0; i < errors.values.size(); ++i) {
            const double common = std::max(std::abs(of_parts.values[i]), usual * means.values[i]);
            errors.values[i] = std::sqrt(std::max(of_pixels.values[i] / (across * down), common * common) / 4);
        }
    }
    static Grid part_means(const Grid& g) {
        return g.blocks(std::max(1, g.width / kParts), std::max(1, g.height / kParts));
    }
};

/// How much darker than `other` blocks of `picture` are, as (other - picture) / (other + picture), where no pixel
/// counts for more than all of `blocks`, the same of another method's both renders.
Grid lack_of(const Image& picture, const Image& other, const Grid& blocks) {
    Grid clipped = grid_of(picture);
    for (int y = 0; y < clipped.height; ++y)
        for (int x = 0; x < clipped.width; ++x) {
            double& v = clipped.values[static_cast<std::size_t>(y * clipped.width + x)];
            v = std::min(v, kBrightestPixel * kTrialBlock * std::max(0.0, blocks.at(x / kBlock, y / kBlock)));
        }
    Grid lack = clipped.blocks(kBlock, kBlock);
    const Grid found = grid_of(other).blocks(kBlock, kBlock);
    const double dark = std::sqrt(least_square(blocks));
    for (std::size_t i = 0; i < lack.values.size(); ++i) {
        const double sum = found.values[i] + lack.values[i] + dark;
        lack.values[i] = sum > 0 ? (found.values[i] - lack.values[i]) / sum : 0;
    }
    return lack;
}

/// The squared error, relative to what `other` finds, of light that `samples` brings in dots: the mean product of what
/// independent renders lack, less what is there by chance.
double light_in_dots(const TrialPictures& samples, const TrialPictures& other) {
    const Grid blocks = mean_of(other).blocks(kBlock, kBlock);
    const Grid a = lack_of(samples.first, other.first, blocks), b = lack_of(samples.second, other.second, blocks);
    RunningStats stats;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        stats.add(
            std::copysign(4 * a.values[i] * b.values[i], a.values[i] * b.values[i] * (a.values[i] + b.values[i])));
    return std::max(0.0, stats.mean() - kErrorsOfDots * stats.standard_error());
}

} // namespace

Image luminance_of(const Picture& picture, const std::string& layer) {
    const Image& beauty = picture.layers.at(layer);
    Image y(beauty.width, beauty.height, 1);
    for (std::size_t i = 0; i < y.data.size(); ++i)
        y.data[i] = static_cast<float>(luminance({beauty.data[3 * i], beauty.data[3 * i + 1], beauty.data[3 * i + 2]}));
    return y;
}

double variance_less(const TrialPictures& wide, const TrialPictures& narrow) {
    const auto of_most = [](const TrialPictures& m) {
        RunningStats stats;
        for (const double v : without_largest(relative_variances(difference_of(m), mean_of(m).smooth()), kRareSamples))
            stats.add(v);
        return stats;
    };
    const RunningStats w = of_most(wide), n = of_most(narrow);
    return std::max(0.0, w.mean() - n.mean() - std::hypot(w.standard_error(), n.standard_error()));
}

double share_of_grain(const TrialPictures& part, const TrialPictures& whole) {
    const Grid picture = mean_of(whole).smooth();
    const auto grain = [&](const TrialPictures& m) { return relative_variance(difference_of(m), picture); };
    const double all = grain(whole);
    return all > 0 ? std::min(1.0, grain(part) / all) : 1;
}

double blur(const TrialPictures& photons, const TrialPictures& samples) {
    const Grid a = difference_of(photons.first, samples.first), b = difference_of(photons.second, samples.second);
    Grid picture = mean_of(photons);
    const Grid of_samples = mean_of(samples);
    for (std::size_t i = 0; i < picture.values.size(); ++i)
        picture.values[i] = (picture.values[i] + of_samples.values[i]) / 2;
    picture = picture.smooth();
    const double dark = least_square(picture);
    Grid products{picture.width, picture.height, {}};
    double excess = 0, all = 0;
    for (std::size_t i = 0; i < picture.values.size(); ++i) {
        const double p = picture.values[i], most = std::sqrt(p * p + dark);
        // What differs by more than all of its light would decide by itself.
        products.values.push_back(most > 0 ? std::clamp(a.values[i] * b.values[i] / (most * most), -1.0, 1.0) : 0);
        excess += std::clamp((a.values[i] + b.values[i]) / 2, -most, most);
        all += p;
    }
    RunningStats stats; // of blocks, for neighbours err alike
    for (const double v : products.blocks(kBlock, kBlock).values) stats.add(v);
    // The squares of light that only photons find add up to no more than it does.
    const double found = all > 0 ? std::max(0.0, excess / all) : 0;
    return std::max(0.0, stats.mean() - stats.standard_error() - found);
}

double share_lit(std::span<const TrialPictures> methods) {
    std::vector<bool> lit(methods.empty() ? 0 : methods[0].first.data.size());
    for (const TrialPictures& m : methods) {
        const Values v = mean_of(m).values;
        for (std::size_t i = 0; i < v.size(); ++i)
            if (v[i] > 0) lit[i] = true;
    }
    return lit.empty() ? 0 : static_cast<double>(std::ranges::count(lit, true)) / static_cast<double>(lit.size());
}

std::vector<TrialError> trial_errors(std::span<const TrialPictures> methods) {
    std::vector<TrialError> errors(methods.size());
    if (methods.empty()) return errors;
    const Values brightness = brightness_of(methods);
    const Grid picture = common_picture(methods, brightness), smooth = picture.smooth();
    const Grid in_blocks = picture.blocks(kBlock, kBlock), in_parts = Parts::part_means(picture);
    std::vector<Parts> parts;
    for (const TrialPictures& m : methods) parts.emplace_back(m);
    // What the picture has at least, in each part, by the method that is surest of most.
    Values least(in_parts.values.size(), 0.0);
    for (const Parts& p : parts)
        for (std::size_t i = 0; i < least.size(); ++i)
            least[i] = std::max(least[i], p.means.values[i] - kStandardErrors * p.errors.values[i]);
    const double dark = least_square(picture);
    for (std::size_t k = 0; k < methods.size(); ++k) {
        // Who finds next to nothing knows nothing of its own errors: two dark renders agree, and a few dots, which
        // would be left out of their differences, allow any part to be as bright as others find it.
        const bool blind = brightness[k] < kFindsNothing;
        const Grid d = difference_of(methods[k]);
        const double trimmed = methods[k].rare_samples ? kTrimmedOfRare : kTrimmed;
        const double pixel = relative_variance(d, smooth, trimmed);
        const double block = relative_variance(d.blocks(kBlock, kBlock), in_blocks, trimmed);
        errors[k].grain = std::max(0.0, pixel - block) * kTrialBlock / (kTrialBlock - 1);
        errors[k].blotches = std::max(0.0, pixel - errors[k].grain);
        double missing = 0;
        for (std::size_t i = 0; i < least.size(); ++i) {
            const double p = std::max(in_parts.values[i], least[i]);
            const double most = parts[k].means.values[i] + kStandardErrors * parts[k].errors.values[i];
            // What the blind ones lack counts though nobody may be sure of it.
            const double lost = blind ? p - brightness[k] * in_parts.values[i] : std::max(0.0, least[i] - most);
            if (p > 0) missing += lost * lost / (p * p + dark);
        }
        errors[k].missing = missing / static_cast<double>(least.size());
        for (std::size_t j = 0; j < methods.size() && !methods[k].by_photons; ++j)
            if (j != k && brightness[j] >= kFindsLight)
                errors[k].dots = std::max(errors[k].dots, light_in_dots(methods[k], methods[j]));
    }
    return errors;
}

} // namespace keyhole
