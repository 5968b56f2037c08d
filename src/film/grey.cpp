#include "film/grey.h"

#include "core/vec.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keyhole {

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

std::vector<std::size_t> without_outliers(const std::vector<double>& values) {
    const auto size = [&](std::size_t i) { return std::isnan(values[i]) ? INFINITY : std::abs(values[i]); };
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto kept = static_cast<std::ptrdiff_t>(static_cast<double>(order.size()) * 0.999);
    std::ranges::nth_element(order, order.begin() + kept, {}, size);
    order.resize(static_cast<std::size_t>(kept));
    return order;
}

double trimmed_mean(const std::vector<double>& values) {
    const std::vector<std::size_t> kept = without_outliers(values);
    double sum = 0;
    for (const std::size_t i : kept) sum += values[i];
    return sum / static_cast<double>(kept.size());
}

} // namespace keyhole
