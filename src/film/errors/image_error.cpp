#include "film/errors/image_error.h"

#include "core/error.h"
#include "film/grey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

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

} // namespace

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

} // namespace keyhole
