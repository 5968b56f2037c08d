#include "film/pass_error.h"

#include "film/image_error.h"

#include <cmath>
#include <limits>

namespace keyhole {

void PassError::add(const AccumulationBuffer& mean) {
    pixels_.resize(mean.pixels());
    ++passes_;
    const auto passes = static_cast<double>(passes_);
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
        Pixel& p = pixels_[i];
        // Welford 1962, by the mean: the pass that moved it from there to here was passes * (here - there) off.
        const double moved = mean.luminance(i) - p.mean;
        p.mean += moved;
        p.m2 += passes * (passes - 1) * moved * moved;
    }
}

double PassError::relative() const {
    if (passes_ < 2) return std::numeric_limits<double>::infinity();
    const auto n = static_cast<double>(pixels_.size()), passes = static_cast<double>(passes_);
    double picture = 0, sum = 0;
    for (const Pixel& p : pixels_) picture += p.mean / n;
    for (const Pixel& p : pixels_) {
        const double variance = p.m2 / (passes - 1) / passes;
        if (variance > 0) sum += variance / error_unit(p.mean, picture) / n;
    }
    return std::sqrt(sum);
}

AccumulatorState PassError::words() const { return accumulator_state(pixels_); }

void PassError::set_words(const AccumulatorState& words, std::int64_t passes) {
    pixels_.resize(words.data.size() * sizeof(std::uint32_t) / sizeof(Pixel));
    set_pixels(pixels_, words);
    passes_ = passes;
}

} // namespace keyhole
