// The loop over pixels that all methods share which sample them one by one.
#pragma once

#include "core/kronecker.h"
#include "core/parallel.h"
#include "core/pixel_sample.h"
#include "core/progress.h"
#include "core/rng.h"
#include "core/statistics.h"
#include "film/film.h"
#include "scene/scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string_view>
#include <vector>

namespace keyhole {

/// Takes one sample of every pixel: sample(window point, random source) -> PixelSample. Each has a random stream of its
/// own, by `round`, and shares the pixel with those of other rounds evenly (LatticeSource). Returns whether it got
/// round before a stop. `luminance_of_samples` receives that of the samples.
template <class Sample>
bool sample_round(const Scene& scene, Film& film, std::int64_t round, std::uint64_t seed, StreamPurpose purpose,
                  const RunContext& context, RunningStats& luminance_of_samples, Sample&& sample) {
    const ImageWindow& window = scene.camera().window();
    constexpr int kTile = 16;
    const int across = (window.width + kTile - 1) / kTile, down = (window.height + kTile - 1) / kTile;
    const auto pixels = static_cast<std::uint64_t>(window.width) * static_cast<std::uint64_t>(window.height);
    const auto sample_number = static_cast<std::uint64_t>(round);
    std::atomic<bool> whole = true;
    std::vector<RunningStats> tiles(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
    parallel_for(static_cast<std::int64_t>(across) * down, [&](std::int64_t tile) {
        if (context.stopped()) {
            whole = false;
            return;
        }
        const int x0 = static_cast<int>(tile % across) * kTile, y0 = static_cast<int>(tile / across) * kTile;
        const int x1 = std::min(x0 + kTile, window.width), y1 = std::min(y0 + kTile, window.height);
        for (int y = y0; y < y1; ++y) {
            for (int x = x0; x < x1; ++x) {
                const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(window.width) +
                                   static_cast<std::uint64_t>(x);
                LatticeSource source(Rng(seed, StreamPurpose::lattice, pixel), sample_number,
                                     Rng(seed, purpose, pixel + pixels * sample_number));
                const double u0 = source.next(), u1 = source.next();
                const Vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                const PixelSample s = sample(window.to_window(centre + film.filter().sample_offset(u0, u1)), source);
                film.add(x, y, s, half_of(round));
                const double l = luminance(s.direct + s.indirect + s.caustic);
                if (std::isfinite(l)) tiles[static_cast<std::size_t>(tile)].add(l);
            }
        }
        context.advance(static_cast<std::uint64_t>((x1 - x0) * (y1 - y0)));
    });
    for (const RunningStats& t : tiles) luminance_of_samples.merge(t);
    return whole;
}

/// A stage of `rounds` rounds. Begins in its constructor, ends at the end of its scope.
class SamplingStage {
  public:
    SamplingStage(const Scene& scene, std::int64_t rounds, std::string_view name, const RunContext& context)
        : context_(context) {
        const ImageWindow& window = scene.camera().window();
        const auto pixels = static_cast<std::uint64_t>(window.width) * static_cast<std::uint64_t>(window.height);
        context.begin(name, pixels * static_cast<std::uint64_t>(rounds), "samples");
    }
    ~SamplingStage() { context_.end(); }
    SamplingStage(const SamplingStage&) = delete;
    SamplingStage& operator=(const SamplingStage&) = delete;

  private:
    const RunContext& context_;
};

} // namespace keyhole
