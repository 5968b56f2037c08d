// The loop over pixels that all methods share which sample them one by one.
#pragma once

#include "core/kronecker.h"
#include "core/parallel.h"
#include "core/pixel_sample.h"
#include "core/progress.h"
#include "core/render_stats.h"
#include "core/rng.h"
#include "core/settings.h"
#include "core/statistics.h"
#include "film/film.h"
#include "scene/scene.h"
#include "session/sampling_density.h"
#include "session/work_partition.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace keyhole {

/// Samples pixels, round by round. Each sample has a random stream of its own, by its number, and shares its pixel with
/// the others evenly (LatticeSource).
class PixelSampling {
  public:
    /// @param share adaptive sampling asks for a render that is made in one go: what has to agree with other parts of
    /// it is sampled evenly.
    PixelSampling(const Scene& scene, const Settings& settings, const WorkPartition& share, StreamPurpose purpose);

    /// Takes a round, of one sample of every pixel, or of one on average once the sampling density is known:
    /// sample(window point, random source) -> PixelSample. Returns whether it got round before a stop. Rounds of an
    /// adaptive render have to be taken one after the other, from 0.
    /// Of `context`, whole_round is for round 0.
    template <class Sample> bool take_round(Film& film, std::int64_t round, const RunContext& context, Sample&& sample);

    /// Of the picture [W/(m^2 sr)], as all samples tell it.
    const RunningStats& luminances() const { return luminances_; }
    /// Puts what adaptive sampling should gain among the values.
    void report(RenderStats& stats) const;
    /// Of the last round, over the number of pixels.
    double samples_per_pixel() const { return static_cast<double>(samples_) / static_cast<double>(pixels_); }

  private:
    static constexpr int kTile = 16, kStep = 4; // pixels
    /// What some pixels showed.
    struct Part {
        RunningStats luminance;
        std::int64_t samples = 0;
    };
    /// The pixel of each kStep x kStep whose turn comes n-th: neighbours far apart, as in ordered dithering.
    static std::pair<int, int> pixel_of_turn(std::int64_t n);
    /// Pixels (x, y) + (step i, step j) of a tile.
    struct PixelsOfTile {
        int x, y, step;
    };
    template <class Sample>
    Part sample_pixels(Film& film, const PixelsOfTile& some, std::int64_t round, const RunContext& context,
                       const Sample& sample);
    template <class Sample>
    void sample_pixel(Film& film, int x, int y, std::int64_t round, Part& part, const Sample& sample);
    /// The numbers of a pixel's samples in a round.
    Range samples_of(std::size_t pixel, std::int64_t round) const;
    void end_of_round(std::int64_t round, const RunContext& context);

    const Scene& scene_;
    std::uint64_t seed_;
    StreamPurpose purpose_;
    std::uint64_t pixels_;
    std::int64_t longest_pilot_; // rounds
    std::optional<SamplingDensity> density_;
    std::int64_t pilot_ = 0; // rounds, once they are over
    double at_begin_ = 0;    // time that was left then [s]
    RunningStats luminances_;
    std::int64_t samples_ = 0;
};

template <class Sample>
bool PixelSampling::take_round(Film& film, std::int64_t round, const RunContext& limit, Sample&& sample) {
    const RunContext context = round == 0 ? limit.first_round() : limit;
    const ImageWindow& window = scene_.camera().window();
    const int across = (window.width + kTile - 1) / kTile, down = (window.height + kTile - 1) / kTile;
    if (round == 0) at_begin_ = context.seconds_left();
    std::atomic<bool> whole = true;
    // Pixels of one sample have no noise that is known. Of a second round that is cut short they lie everywhere, where
    // a seam would show; rays of pixels apart take up to a sixth longer.
    const std::int64_t tiles = std::int64_t{across} * down, turns = round == 1 ? kStep * kStep : 1;
    std::vector<Part> parts(static_cast<std::size_t>(turns * tiles));
    parallel_for(turns * tiles, [&](std::int64_t i) {
        if (context.stopped()) {
            whole = false;
            return;
        }
        const auto [right, below] = pixel_of_turn(i / tiles);
        const int x = static_cast<int>(i % tiles % across) * kTile, y = static_cast<int>(i % tiles / across) * kTile;
        parts[static_cast<std::size_t>(i)] =
            sample_pixels(film, {x + right, y + below, turns > 1 ? kStep : 1}, round, context, sample);
    });
    samples_ = 0;
    for (const Part& p : parts) {
        luminances_.merge(p.luminance);
        samples_ += p.samples;
    }
    if (whole) end_of_round(round, context);
    return whole;
}

template <class Sample>
PixelSampling::Part PixelSampling::sample_pixels(Film& film, const PixelsOfTile& some, std::int64_t round,
                                                 const RunContext& context, const Sample& sample) {
    const ImageWindow& window = scene_.camera().window();
    const auto& [x, y, step] = some;
    const int right = std::min((x / kTile + 1) * kTile, window.width),
              bottom = std::min((y / kTile + 1) * kTile, window.height);
    Part part;
    std::uint64_t pixels = 0;
    for (int j = y; j < bottom; j += step)
        for (int i = x; i < right; i += step, ++pixels) sample_pixel(film, i, j, round, part, sample);
    context.advance(pixels);
    return part;
}

template <class Sample>
void PixelSampling::sample_pixel(Film& film, int x, int y, std::int64_t round, Part& part, const Sample& sample) {
    const ImageWindow& window = scene_.camera().window();
    const auto pixel =
        static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(window.width) + static_cast<std::uint64_t>(x);
    const Range numbers = samples_of(pixel, round);
    for (std::int64_t n = numbers.begin; n < numbers.end; ++n) {
        const auto number = static_cast<std::uint64_t>(n);
        LatticeSource source(Rng(seed_, StreamPurpose::lattice, pixel), number,
                             Rng(seed_, purpose_, pixel + pixels_ * number));
        const double u0 = source.next(), u1 = source.next();
        const Vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        const PixelSample s = sample(window.to_window(centre + film.filter().sample_offset(u0, u1)), source);
        film.add(x, y, s, half_of(n));
        const double l = luminance(s.direct + s.indirect + s.caustic);
        ++part.samples;
        if (!std::isfinite(l)) continue;
        part.luminance.add(density_ ? l / density_->at(pixel) : l);
        if (density_ && !density_->is_decided()) density_->add(pixel, l, half_of(n));
    }
}

/// A stage of `rounds` rounds.
struct SamplingStage : ProgressStage {
    SamplingStage(const Scene& scene, std::int64_t rounds, std::string_view name, const RunContext& context)
        : ProgressStage(context, name,
                        static_cast<std::uint64_t>(scene.camera().window().size()) * static_cast<std::uint64_t>(rounds),
                        "samples") {}
};

} // namespace keyhole
