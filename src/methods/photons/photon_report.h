// Whether the photons of a pass can be trusted.
#pragma once

#include "core/render_stats.h"
#include "gather/final_gather.h"
#include "gather/irradiance_cache.h"
#include "photonmap/irradiance/irradiance_map.h"
#include "photonmap/photons.h"

#include <optional>

namespace keyhole {

/// Puts into `stats` how many photons there are, and how much of the power the brightest 0.1 % of them carry, of the
/// map where that is more.
void report_photons(const Photons& photons, RenderStats& stats);

/// Cuts outliers among the photons of chains, where one of `passes` is all there is: a mean over many needs no cut.
void cut_outliers(Photons& photons, std::int64_t passes, RenderStats& stats);

/// Puts into `stats` how many photons went into an estimate, on average, how many equal ones would be as good, and what
/// share of `asked` was found.
void report_lookups(const IrradianceMap& map, double asked, RenderStats& stats);

/// Puts into `stats` how many records there are, how noisy their light is, and for what share of the visible points
/// there was none.
void report_cache(const IrradianceCache& cache, double starving, RenderStats& stats);

/// Puts into `stats` in what share of the picture caustics that pilot photons don't confirm are more than a tenth of
/// the light there, and of the mean.
void report_false_spots(const FinalGather& gather, std::uint64_t seed, RenderStats& stats);

/// How noisy samples of pixels are, and what records of the cache add to that; none where the picture is black.
/// Takes kSamplesInPixel samples in each of `pixels`.
constexpr int kPixelsForNoise = 256, kSamplesInPixel = 8;
std::optional<PhotonQuality::Noise> noise_of(const FinalGather& gather, const ImageWindow& window, std::uint64_t seed,
                                             int pixels = kPixelsForNoise);

/// Warns by what the last of `passes` left in `stats`: few photons with most of the power, maps too sparse where they
/// are asked, spots of light that pilot photons don't confirm, an irradiance cache that is noisy or without answers, no
/// photons at all; as far as paths of at most `max_depth` scatterings ask them.
void warn_of_photons(RenderStats& stats, std::int64_t passes, std::int64_t max_depth);

} // namespace keyhole
