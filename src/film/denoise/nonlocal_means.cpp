#include "film/denoise/nonlocal_means.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

/// Differences below a tenth of a channel's range are no edges.
constexpr float kLeastSquare = 0.01f;
/// The difference that counts as 1, over what a channel varies around there.
constexpr float kGuideBandwidth = 0.8f;
/// Pixels around one over which the noise of its channels is averaged.
constexpr int kReachOfGuideNoise = 1;

/// The difference of luminance that counts as 1, over the noise of both pixels.
constexpr float kBandwidth = 0.6f;
/// More than this can't make a patch more unlike.
constexpr float kMostUnlike = 1e6f;

constexpr int kAcross = 64, kDown = 16; // pixels of a tile
constexpr int kPatchSize = 2 * kPatch + 1;

/// Of distance d: 1 at 0, and 0 from 3 on; an exponential within a few per cent, without its cost.
float kernel(float distance) {
    const float t = std::max(0.0f, 1 - distance / 3);
    return t * t * t;
}

/// 1 at the pixel itself, and 0 beyond `reach`: what of noise is left has soft edges then.
float nearness(int dx, int dy, int reach) {
    const float end = static_cast<float>(reach) + 0.5f;
    return 1 - static_cast<float>(dx * dx + dy * dy) / (end * end);
}

/// A tile's pixels, and the sums that are made of them.
class Tile {
  public:
    /// `border`: pixels around it that the filter looks at.
    Tile(const HalfPictures& halves, const FilterGuides& guides, int x, int y, int border)
        : halves_(halves), guides_(guides), x_(x), y_(y), width_(std::min(kAcross, halves.variance.width() - x)),
          height_(std::min(kDown, halves.variance.height() - y)), whole_(is_whole(border)) {}

    /// Adds for every pixel the one that is (dx, dy) away, if there is one, with a weight of at most `most`.
    void add(int dx, int dy, float most) {
        for (std::size_t half = 0; half < 2; ++half) find_likeness(half, dx, dy);
        const int left = std::max(0, -dx - x_), right = std::min(width_, halves_.variance.width() - dx - x_);
        const int top = std::max(0, -dy - y_), bottom = std::min(height_, halves_.variance.height() - dy - y_);
        std::array<float, kAcross> apart{}, weight;
        for (int row = top; row < bottom; ++row) {
            guides_.distances(x_, y_ + row, dx, dy, width_, apart.data());
            for (std::size_t half = 0; half < 2; ++half) {
                const auto& unlike = unlike_[1 - half][static_cast<std::size_t>(row)];
                Sums& sums = sums_[half][static_cast<std::size_t>(row)];
                for (std::size_t i = 0; i < kAcross; ++i) weight[i] = most * kernel(std::max(unlike[i], apart[i]));
                const float* there = halves_.there[half].at(x_ + dx, y_ + row + dy);
                for (int i = left; i < right; ++i)
                    sums.weights[static_cast<std::size_t>(i)] += weight[static_cast<std::size_t>(i)] * there[i];
                for (std::size_t c = 0; c < 3; ++c) {
                    const float* colour = halves_.colours[half][c].at(x_ + dx, y_ + row + dy);
                    for (int i = left; i < right; ++i)
                        sums.colours[c][static_cast<std::size_t>(i)] += weight[static_cast<std::size_t>(i)] * colour[i];
                }
            }
        }
    }

    void write(std::array<Image, 2>& filtered) const {
        for (std::size_t half = 0; half < 2; ++half)
            for (int row = 0; row < height_; ++row) {
                const Sums &sums = sums_[half][static_cast<std::size_t>(row)],
                           &other = sums_[1 - half][static_cast<std::size_t>(row)];
                for (std::size_t i = 0; i < static_cast<std::size_t>(width_); ++i) {
                    // A pixel that is there weighs 1 itself.
                    const float lacking = std::max(0.0f, 1 - sums.weights[i]);
                    for (std::size_t c = 0; c < 3; ++c) {
                        float sum = sums.colours[c][i];
                        if (lacking > 0) sum += lacking * other.colours[c][i] / other.weights[i];
                        filtered[half].at(x_ + static_cast<int>(i), y_ + row)[c] = sum / (sums.weights[i] + lacking);
                    }
                }
            }
    }

  private:
    struct Sums {
        std::array<float, kAcross> weights{};
        std::array<std::array<float, kAcross>, 3> colours{};
    };
    /// Whether both halves have all pixels up to `border` away.
    bool is_whole(int border) const {
        for (int y = y_ - border; y < y_ + height_ + border; ++y) {
            const float* there = halves_.there[0].at(x_ - border, y);
            if (std::any_of(there, there + width_ + 2 * border, [](float share) { return share != 1; })) return false;
        }
        return true;
    }

    using Row = std::array<float, kAcross + 2 * kPatch>; // and kPatch more on either side
    using Rows = std::array<std::array<float, kAcross>, kDown>;

    /// sums[row][i]: of the terms over the patch around a pixel. fill(x, y, n, terms) sets those of a row.
    template <class Fill> void sum_patches(Rows& sums, Fill&& fill) const {
        std::array<std::array<float, kAcross>, kDown + 2 * kPatch> across; // sums over the columns of a patch
        for (int row = 0; row < height_ + 2 * kPatch; ++row) {
            Row terms{};
            fill(x_ - kPatch, y_ + row - kPatch, width_ + 2 * kPatch, terms.data());
            for (std::size_t i = 0; i < kAcross; ++i) {
                float sum = 0;
                for (std::size_t k = 0; k < kPatchSize; ++k) sum += terms[i + k];
                across[static_cast<std::size_t>(row)][i] = sum;
            }
        }
        for (std::size_t row = 0; row < static_cast<std::size_t>(height_); ++row)
            for (std::size_t i = 0; i < kAcross; ++i) {
                float sum = 0;
                for (std::size_t k = 0; k < kPatchSize; ++k) sum += across[row + k][i];
                sums[row][i] = sum;
            }
    }

    /// The mean distance of patches, by pixel: of luminance, squared, beyond its noise and in units of that. Over
    /// pixels that the half has in both patches. The fewer these are, the more does chance decide: it is scaled to
    /// spread as that of all pixels does. Without any, patches pass for alike, and guides decide.
    void find_likeness(std::size_t half, int dx, int dy) {
        const Plane &luminance = halves_.luminances[half], &variance = halves_.variance, &seen = halves_.there[half];
        sum_patches(unlike_[half], [&](int x, int y, int n, float* distance) {
            const float *here = luminance.at(x, y), *there = luminance.at(x + dx, y + dy);
            const float *noise = variance.at(x, y), *other_noise = variance.at(x + dx, y + dy);
            for (int i = 0; i < n; ++i) {
                const float difference = here[i] - there[i];
                const float beyond = difference * difference - (noise[i] + std::min(noise[i], other_noise[i]));
                const float unit = kBandwidth * kBandwidth * (noise[i] + other_noise[i]);
                distance[i] = std::min(kMostUnlike, beyond / (unit + std::numeric_limits<float>::min()));
            }
            if (whole_) return;
            const float *is_here = seen.at(x, y), *is_there = seen.at(x + dx, y + dy);
            for (int i = 0; i < n; ++i) distance[i] *= is_here[i] * is_there[i] > 0 ? 1.0f : 0.0f;
        });
        if (whole_) {
            for (auto& row : unlike_[half])
                for (float& d : row) d /= kPatchSize * kPatchSize;
            return;
        }
        Rows pixels;
        sum_patches(pixels, [&](int x, int y, int n, float* both) {
            const float *is_here = seen.at(x, y), *is_there = seen.at(x + dx, y + dy);
            for (int i = 0; i < n; ++i) both[i] = is_here[i] * is_there[i] > 0 ? 1.0f : 0.0f;
        });
        for (std::size_t row = 0; row < static_cast<std::size_t>(height_); ++row)
            for (std::size_t i = 0; i < kAcross; ++i)
                unlike_[half][row][i] /= kPatchSize * std::sqrt(std::max(1.0f, pixels[row][i]));
    }

    const HalfPictures& halves_;
    const FilterGuides& guides_;
    int x_, y_, width_, height_;
    bool whole_; ///< every pixel that it looks at is in both halves
    std::array<Rows, 2> unlike_{};
    std::array<std::array<Sums, kDown>, 2> sums_{};
};

} // namespace

FilterGuides::FilterGuides(const Picture& picture, int border) {
    const int width = picture.width, height = picture.height;
    for (const char* name : {"albedo", "normal"}) {
        const Image &layer = picture.layers.at(name), &noise = picture.layers.at(noise_layer(name));
        for (int c = 0; c < 3; ++c)
            add(
                width, height, border, [&](int x, int y) { return layer.at(x, y)[c]; },
                [&](int x, int y) { return noise.at(x, y)[c]; });
    }
    // Depth goes without bound: z / (z + mean) lies between 0 and 1 in scenes of any size.
    const Image &depth = picture.layers.at("depth"), &noise = picture.layers.at(noise_layer("depth"));
    double sum = 0;
    for (const float z : depth.data) sum += z;
    const float mean = std::max(1e-30f, static_cast<float>(sum / static_cast<double>(depth.data.size())));
    add(
        width, height, border,
        [&](int x, int y) {
            const float z = *depth.at(x, y);
            return z / (z + mean);
        },
        [&](int x, int y) {
            const float z = *depth.at(x, y);
            return *noise.at(x, y) * mean / ((z + mean) * (z + mean));
        });
}

void FilterGuides::add(int width, int height, int border, auto&& value, auto&& noise) {
    Plane values(width, height, border, value);
    Plane variance = box_mean(width, height, border, kReachOfGuideNoise, [&](int x, int y) {
        const float d = noise(x, y);
        return d * d;
    });
    Plane precision(width, height, border, [&](int x, int y) {
        // An edge within a pixel's reach is met by all its neighbours.
        const float across = (values(std::min(x + 1, width - 1), y) - values(std::max(x - 1, 0), y)) / 2,
                    down = (values(x, std::min(y + 1, height - 1)) - values(x, std::max(y - 1, 0))) / 2;
        const float scale = std::max({kLeastSquare, variance(x, y), across * across + down * down});
        return 1 / (kGuideBandwidth * kGuideBandwidth * scale);
    });
    channels_.push_back({std::move(values), std::move(variance), std::move(precision)});
}

void FilterGuides::distances(int x, int y, int dx, int dy, int n, float* distance) const {
    std::fill_n(distance, n, 0.0f);
    for (const Channel& c : channels_) {
        const float *here = c.value.at(x, y), *there = c.value.at(x + dx, y + dy);
        const float *noise = c.variance.at(x, y), *other_noise = c.variance.at(x + dx, y + dy);
        const float* precision = c.precision.at(x, y);
        for (int i = 0; i < n; ++i) {
            const float difference = here[i] - there[i];
            const float beyond = difference * difference - (noise[i] + std::min(noise[i], other_noise[i]));
            distance[i] = std::max(distance[i], beyond * precision[i]);
        }
    }
}

std::array<Image, 2> filter_crosswise(const HalfPictures& halves, const FilterGuides& guides, int reach,
                                      const StopToken* stop) {
    const int width = halves.variance.width(), height = halves.variance.height();
    std::array<Image, 2> filtered{Image(width, height, 3), Image(width, height, 3)};
    const int across = (width + kAcross - 1) / kAcross, down = (height + kDown - 1) / kDown;
    parallel_for(std::int64_t{across} * down, [&](std::int64_t i) {
        if (stop != nullptr && stop->requested()) return;
        Tile tile(halves, guides, static_cast<int>(i % across) * kAcross, static_cast<int>(i / across) * kDown,
                  reach + kPatch);
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx)
                if (const float near = nearness(dx, dy, reach); near > 0) tile.add(dx, dy, near);
        tile.write(filtered);
    });
    return filtered;
}

} // namespace keyhole
