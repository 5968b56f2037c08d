#include "session/sampling_density.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

namespace keyhole {
namespace {

using Values = std::vector<float>; // by pixel

/// Bounds of the density: what is rare may be anywhere, and a single bright sample is no reason to leave the rest of
/// the picture alone.
constexpr float kLeast = 0.3f, kMost = 4;
/// Share of the squared mean of the picture that is added to that of a pixel: errors of dark ones are seen less.
constexpr double kDark = 0.01;
/// Pixels around each that are asked: squares that reach so far.
constexpr std::array kReaches{1, 2, 4, 8};
/// Reach of the surroundings that a pixel's error is relative to.
constexpr int kReachOfLight = 4;
/// Of pixels, those with the largest errors that count no more than the next: chance alone tells which they are.
constexpr double kOutliers = 0.01;

double mean(const Values& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// A number for each pixel, and their sums over squares, by a summed-area table (Crow 1984). In double precision: a
/// pixel is taken out of the sum around it again, and may be a million times as large as its neighbours.
class SummedArea {
  public:
    SummedArea(int width, int height, Values values)
        : width_(width), height_(height), values_(std::move(values)),
          sums_((static_cast<std::size_t>(width) + 1) * (static_cast<std::size_t>(height) + 1), 0.0) {
        auto value = values_.begin();
        for (int y = 1; y <= height; ++y)
            for (int x = 1; x <= width; ++x)
                sums_[corner(x, y)] = static_cast<double>(*value++) + sums_[corner(x - 1, y)] +
                                      sums_[corner(x, y - 1)] - sums_[corner(x - 1, y - 1)];
    }

    /// Of the pixels of a square around one.
    struct Sum {
        double sum;
        int pixels;
    };
    Sum around(int x, int y, int reach) const {
        const int x0 = std::max(0, x - reach), x1 = std::min(width_, x + reach + 1);
        const int y0 = std::max(0, y - reach), y1 = std::min(height_, y + reach + 1);
        return {sums_[corner(x1, y1)] - sums_[corner(x0, y1)] - sums_[corner(x1, y0)] + sums_[corner(x0, y0)],
                (x1 - x0) * (y1 - y0)};
    }
    double mean_around(int x, int y, int reach) const {
        const Sum all = around(x, y, reach);
        return all.sum / all.pixels;
    }
    /// Without the pixel itself; 0 where there is no other.
    double mean_of_neighbours(int x, int y, int reach) const {
        const Sum all = around(x, y, reach);
        return all.pixels > 1 ? std::max(0.0, all.sum - at(x, y)) / (all.pixels - 1) : 0;
    }
    double mean_of_all() const { return sums_.back() / static_cast<double>(values_.size()); }
    double at(int x, int y) const {
        return static_cast<double>(
            values_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)]);
    }

    /// f(x, y) of all pixels.
    template <class F> Values map(const F& f) const {
        Values result;
        result.reserve(values_.size());
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) result.push_back(static_cast<float>(f(x, y)));
        return result;
    }

  private:
    std::size_t corner(int x, int y) const {
        return static_cast<std::size_t>(y) * (static_cast<std::size_t>(width_) + 1) + static_cast<std::size_t>(x);
    }

    int width_, height_;
    Values values_;
    std::vector<double> sums_; // of all pixels above and left of each corner
};

/// `values` times the factor that makes their mean 1 once they are clamped to the bounds. Where hardly any isn't 0 all
/// get nearly the same.
Values bounded(const Values& values) {
    Values density = values;
    double factor = 1;
    for (int i = 0; i < 8; ++i) { // what the bounds take or give is shared out among the others
        const double m = mean(density);
        if (!(m > 0)) return Values(values.size(), 1.0f);
        factor /= m;
        std::ranges::transform(values, density.begin(), [&](float v) {
            return std::clamp(static_cast<float>(factor * static_cast<double>(v)), kLeast, kMost);
        });
    }
    const auto m = static_cast<float>(mean(density));
    for (float& d : density) d /= m;
    return density;
}

/// What samples of pixels tell of a picture.
class Pilot {
  public:
    Pilot(const std::vector<RunningStats>& pixels, int width, int height)
        : light_(width, height, of_all(pixels, &RunningStats::mean)),
          variance_(width, height, of_all(pixels, &RunningStats::variance)),
          dark_(kDark * light_.mean_of_all() * light_.mean_of_all()) {}

    /// That the pixels around each ask for.
    Values density(int reach) const {
        return bounded(variance_.map([&](int x, int y) {
            const double light = light_.mean_of_neighbours(x, y, reach);
            return std::sqrt(ratio(variance_.mean_of_neighbours(x, y, reach), light * light + dark_));
        }));
    }
    /// The relative variance of a sample of each pixel, up to that of outliers.
    Values errors() const {
        Values errors = variance_.map([&](int x, int y) {
            const double light = light_.mean_around(x, y, kReachOfLight);
            return ratio(variance_.at(x, y), light * light + dark_);
        });
        Values sorted = errors;
        const auto most =
            sorted.begin() + static_cast<std::ptrdiff_t>((1 - kOutliers) * static_cast<double>(sorted.size() - 1));
        std::ranges::nth_element(sorted, most);
        for (float& e : errors) e = std::min(e, *most);
        return errors;
    }

  private:
    static Values of_all(const std::vector<RunningStats>& pixels, double (RunningStats::*figure)() const) {
        Values values(pixels.size());
        std::ranges::transform(pixels, values.begin(),
                               [&](const RunningStats& p) { return static_cast<float>((p.*figure)()); });
        return values;
    }
    static double ratio(double variance, double square) { return variance > 0 ? variance / square : 0; }

    SummedArea light_, variance_;
    double dark_; // added to the square of light
};

/// The sum of squared errors where samples have this density; those of `errors` are of one sample.
double error_left(const Values& errors, const Values& density) {
    return std::transform_reduce(errors.begin(), errors.end(), density.begin(), 0.0, std::plus(),
                                 [](float e, float d) { return static_cast<double>(e / d); });
}

} // namespace

SamplingDensity::SamplingDensity(int width, int height) : width_(width), height_(height) {
    pilot_.fill(Stats(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)));
}

void SamplingDensity::decide() {
    const Pilot first(pilot_[0], width_, height_), second(pilot_[1], width_, height_);
    for (std::size_t p = 0; p < pilot_[0].size(); ++p) pilot_[0][p].merge(pilot_[1][p]);
    const Pilot both(pilot_[0], width_, height_);
    pilot_ = {};
    density_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 1.0f);
    const Values of_first = first.errors(), of_second = second.errors();
    const double even = error_left(of_first, density_) + error_left(of_second, density_);
    std::optional<int> best; // reach; none: even
    for (const int reach : kReaches) {
        const double left = error_left(of_second, first.density(reach)) + error_left(of_first, second.density(reach));
        if (left >= error_over_even_ * even) continue;
        error_over_even_ = left / even;
        best = reach;
    }
    if (best) density_ = both.density(*best);
}

std::int64_t SamplingDensity::samples_before(std::size_t pixel, std::int64_t round, double shift) const {
    return static_cast<std::int64_t>(std::floor(at(pixel) * static_cast<double>(round) + shift));
}

} // namespace keyhole
