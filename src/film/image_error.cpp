#include "film/image_error.h"

#include "core/error.h"
#include "core/statistics.h"
#include "core/vec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace keyhole {
namespace {

/// Mean over the 3x3 neighbourhood of each pixel; the border repeats.
std::vector<double> smooth(const Grey& g) {
    const auto clamped = [](std::size_t i, std::size_t step, std::size_t n) {
        return std::min(std::max(i + step, std::size_t{1}) - 1, n - 1);
    };
    std::vector<double> out(g.y.size());
    for (std::size_t row = 0; row < g.height; ++row) {
        for (std::size_t x = 0; x < g.width; ++x) {
            double sum = 0;
            for (std::size_t j = 0; j < 3; ++j)
                for (std::size_t i = 0; i < 3; ++i)
                    sum += g.y[clamped(row, j, g.height) * g.width + clamped(x, i, g.width)];
            out[row * g.width + x] = sum / 9;
        }
    }
    return out;
}

/// Indices of the values that are left without the 0.1 % largest in size, NaN being the largest of all.
std::vector<std::size_t> without_outliers(const std::vector<double>& values) {
    const auto size = [&](std::size_t i) { return std::isnan(values[i]) ? INFINITY : std::abs(values[i]); };
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto kept = static_cast<std::ptrdiff_t>(static_cast<double>(order.size()) * 0.999);
    std::ranges::nth_element(order, order.begin() + kept, {}, size);
    order.resize(static_cast<std::size_t>(kept));
    return order;
}

/// Mean of these; NaN without any.
double trimmed_mean(const std::vector<double>& values) {
    const std::vector<std::size_t> kept = without_outliers(values);
    double sum = 0;
    for (const std::size_t i : kept) sum += values[i];
    return sum / static_cast<double>(kept.size());
}

double block_error(const Grey& picture, const Grey& reference, double mean_reference) {
    constexpr std::size_t kBlock = 16;
    const auto block_mean = [](const Grey& g, std::size_t x0, std::size_t y0) {
        double sum = 0;
        for (std::size_t y = y0; y < y0 + kBlock; ++y)
            for (std::size_t x = x0; x < x0 + kBlock; ++x) sum += g.y[y * g.width + x];
        return sum / (kBlock * kBlock);
    };
    std::vector<double> squares;
    for (std::size_t y = 0; y + kBlock <= picture.height; y += kBlock) {
        for (std::size_t x = 0; x + kBlock <= picture.width; x += kBlock) {
            const double r = std::max(block_mean(reference, x, y), 1e-6 * mean_reference);
            const double e = block_mean(picture, x, y) / r - 1;
            squares.push_back(e * e);
        }
    }
    return std::sqrt(mean(squares));
}

/// (a - r1)(a - r2) / (light^2 + 0.01 mean^2), pixel by pixel.
std::vector<double> relative_products(const Grey& a, const Grey& r1, const Grey& r2, const std::vector<double>& light,
                                      double mean) {
    std::vector<double> e(a.y.size());
    for (std::size_t i = 0; i < e.size(); ++i)
        e[i] = (a.y[i] - r1.y[i]) * (a.y[i] - r2.y[i]) / error_unit(light[i], mean);
    return e;
}

void check_size(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height)
        throw InputError(fmt::format("sizes differ: {} x {} and {} x {} pixels", a.width, a.height, b.width, b.height));
}

Grey finite_grey(const Image& image, const Image& reference) {
    if (image.width != reference.width || image.height != reference.height)
        throw InputError("found pictures of different sizes, expected equal ones");
    Grey grey(image);
    for (double& y : grey.y)
        if (!std::isfinite(y)) y = 0;
    return grey;
}

} // namespace

Grey::Grey(const Image& image)
    : width(static_cast<std::size_t>(image.width)), height(static_cast<std::size_t>(image.height)), y(width * height) {
    const auto n = static_cast<std::size_t>(image.channels);
    for (std::size_t i = 0; i < y.size(); ++i) {
        const float* p = image.data.data() + n * i;
        y[i] = n < 3 ? double{p[0]} : luminance({p[0], p[1], p[2]});
    }
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

ImageError image_error(const Image& picture, const Image& reference, const Image* second_reference) {
    check_size(picture, reference);
    Grey i(picture), r(reference);
    ImageError error;
    for (double& y : i.y) {
        if (!std::isfinite(y) || y < 0) ++error.bad;
        if (!std::isfinite(y)) y = 0;
    }
    if (second_reference != nullptr) {
        check_size(picture, *second_reference);
        const Grey r1 = r, r2(*second_reference);
        for (std::size_t p = 0; p < r.y.size(); ++p) r.y[p] = (r1.y[p] + r2.y[p]) / 2;
        const auto products = relative_products(i, r1, r2, smooth(r), mean(r.y));
        error.cross = mean(products);
        error.cross_trim = trimmed_mean(products);
    }
    const double mean_r = mean(r.y);
    const auto squares = relative_products(i, r, r, r.y, mean_r);
    error.relmse = mean(squares);
    error.relmse_trim = trimmed_mean(squares);
    std::vector<double> lit;
    for (std::size_t p = 0; p < r.y.size(); ++p)
        if (r.y[p] > 1e-4 * mean_r) lit.push_back((i.y[p] / r.y[p] - 1) * (i.y[p] / r.y[p] - 1));
    error.rms_rel = std::sqrt(mean(lit));
    error.ratio = mean(i.y) / mean_r;
    error.block = block_error(i, r, mean_r);
    return error;
}

RepeatError repeat_error(const std::vector<Image>& repeats, const Image& reference, const Image* second_reference) {
    const Grey r1 = finite_grey(reference, reference);
    const Grey r2 = second_reference != nullptr ? finite_grey(*second_reference, reference) : r1;
    Grey r = r1;
    for (std::size_t p = 0; p < r.y.size(); ++p) r.y[p] = (r1.y[p] + r2.y[p]) / 2;
    const std::vector<double> smoothed = smooth(r);
    const double mean_r = mean(r.y);

    std::vector<Grey> pictures;
    pictures.reserve(repeats.size());
    for (const Image& image : repeats) pictures.push_back(finite_grey(image, reference));
    const auto error_of = [&](const Grey& picture, std::size_t p) {
        return (picture.y[p] - r1.y[p]) * (picture.y[p] - r2.y[p]) / error_unit(smoothed[p], mean_r);
    };
    std::vector<double> errors(r.y.size(), 0.0);
    for (std::size_t p = 0; p < errors.size(); ++p)
        for (const Grey& picture : pictures) errors[p] += error_of(picture, p) / static_cast<double>(pictures.size());

    const std::vector<std::size_t> kept = without_outliers(errors);
    RepeatError result{.each = std::vector<double>(pictures.size(), 0.0)};
    const double share = 1 / static_cast<double>(kept.size());
    for (const std::size_t p : kept) {
        RunningStats values;
        for (std::size_t k = 0; k < pictures.size(); ++k) {
            result.each[k] += share * error_of(pictures[k], p);
            values.add(pictures[k].y[p]);
        }
        result.error += share * errors[p];
        result.variance += share * values.variance() / error_unit(smoothed[p], mean_r);
    }
    if (pictures.size() < 2) result.variance = std::numeric_limits<double>::quiet_NaN();
    result.bias = result.error - result.variance;
    return result;
}

std::optional<double> sample_noise(const Picture& picture) {
    const Image& beauty = picture.layers.at("beauty");
    Image noise(beauty.width, beauty.height, 3);
    for (const char* name : {"direct", "indirect", "caustic"}) {
        const auto layer = picture.layers.find(name), of_layer = picture.layers.find(noise_layer(name));
        if (layer == picture.layers.end() || of_layer == picture.layers.end()) return std::nullopt;
        const auto is_black = [](const Image& image) {
            return std::ranges::all_of(image.data, [](float v) { return v == 0; });
        };
        if (is_black(of_layer->second) && !is_black(layer->second)) return std::nullopt;
        std::ranges::transform(noise.data, of_layer->second.data, noise.data.begin(), std::plus());
    }
    const Grey light(beauty), difference(noise);
    const std::vector<double> smoothed = smooth(light);
    const double mean_light = mean(light.y);
    std::vector<double> squares;
    for (std::size_t i = 0; i < light.y.size(); ++i)
        if (difference.y[i] != 0 || light.y[i] == 0) // known
            squares.push_back(difference.y[i] * difference.y[i] / error_unit(smoothed[i], mean_light));
    const double noise_of_all = std::sqrt(trimmed_mean(squares));
    return std::isfinite(noise_of_all) ? std::optional(noise_of_all) : std::nullopt;
}

} // namespace keyhole
