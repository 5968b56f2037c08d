// The loop over pixels that all methods share which sample them one by one.
#pragma once

#include "core/lattice_source.h"
#include "core/parallel.h"
#include "core/pixel_sample.h"
#include "core/progress.h"
#include "core/rng.h"
#include "film/film.h"
#include "scene/scene.h"

#include <algorithm>
#include <string_view>

namespace keyhole {

/// Takes `spp` samples of every pixel: sample(window point, random source) -> PixelSample. Works in rounds of one
/// sample for every pixel, so that a stop leaves a whole picture. Each sample has a random stream of its own, by
/// `first_round` plus the rounds before it, and shares the pixel with the others evenly (LatticeSource). Returns the
/// number of full rounds.
template <class Sample>
std::int64_t sample_pixels(const Scene& scene, Film& film, std::int64_t spp, std::uint64_t seed, StreamPurpose purpose,
                           std::string_view stage, const RunContext& context, Sample&& sample,
                           std::int64_t first_round = 0) {
    const ImageWindow& window = scene.camera().window();
    constexpr int kTile = 16;
    const int across = (window.width + kTile - 1) / kTile, down = (window.height + kTile - 1) / kTile;
    const auto pixels = static_cast<std::uint64_t>(window.width) * static_cast<std::uint64_t>(window.height);
    context.begin(stage, pixels * static_cast<std::uint64_t>(spp), "samples");
    std::int64_t round = 0;
    for (; round < spp && !context.stopped(); ++round) {
        parallel_for(static_cast<std::int64_t>(across) * down, [&](std::int64_t tile) {
            if (context.stopped()) return;
            const int x0 = static_cast<int>(tile % across) * kTile, y0 = static_cast<int>(tile / across) * kTile;
            const int x1 = std::min(x0 + kTile, window.width), y1 = std::min(y0 + kTile, window.height);
            for (int y = y0; y < y1; ++y) {
                for (int x = x0; x < x1; ++x) {
                    const auto pixel = static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(window.width) +
                                       static_cast<std::uint64_t>(x);
                    const auto sample_number = static_cast<std::uint64_t>(first_round + round);
                    LatticeSource source(Rng(seed, StreamPurpose::lattice, pixel), sample_number,
                                         Rng(seed, purpose, pixel + pixels * sample_number));
                    const double u0 = source.next(), u1 = source.next();
                    const Vec2 centre(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                    film.add(x, y, sample(window.to_window(centre + film.filter().sample_offset(u0, u1)), source));
                }
            }
            context.advance(static_cast<std::uint64_t>((x1 - x0) * (y1 - y0)));
        });
    }
    context.end();
    return round;
}

} // namespace keyhole
