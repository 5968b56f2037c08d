#include "film/pass_error.h"

#include <cmath>
#include <limits>

namespace keyhole {

void PassError::add(const Film& film) {
    const auto n = static_cast<std::size_t>(film.width()) * static_cast<std::size_t>(film.height());
    pixels_.resize(n);
    ++passes_;
    for (std::size_t i = 0; i < n; ++i) {
        Pixel& p = pixels_[i];
        const auto [sum, samples] = film.luminance_sum(i);
        const double value = samples > p.samples ? (sum - p.sum) / (samples - p.samples) : p.mean;
        p.sum = sum;
        p.samples = samples;
        const double d = value - p.mean; // Welford 1962
        p.mean += d / static_cast<double>(passes_);
        p.m2 += d * (value - p.mean);
    }
}

double PassError::relative() const {
    if (passes_ < 2) return std::numeric_limits<double>::infinity();
    const auto n = static_cast<double>(pixels_.size()), passes = static_cast<double>(passes_);
    double picture = 0, sum = 0;
    for (const Pixel& p : pixels_) picture += p.mean / n;
    for (const Pixel& p : pixels_) {
        const double variance = p.m2 / (passes - 1) / passes, size = p.mean * p.mean + 0.01 * picture * picture;
        if (variance > 0) sum += variance / size / n;
    }
    return std::sqrt(sum);
}

} // namespace keyhole
