// Stage three of a pass: what the eye sees, from the photons of the pass.
#pragma once

#include "gather/direct_irradiance_cache.h"
#include "gather/fill_cache.h"
#include "gather/final_gather.h"
#include "gather/irradiance_cache.h"
#include "methods/photons/photon_sampler.h"
#include "methods/photons/plan.h"
#include "methods/photons/radii.h"
#include "photonmap/irradiance/irradiance_map.h"
#include "photonmap/photons.h"
#include "photonmap/pilot_surroundings.h"
#include "photonmap/piloted_map.h"

#include <cstdint>
#include <optional>

namespace keyhole {

/// The maps of a pass and its irradiance cache, ready to be asked for samples of pixels. Thread-safe once it is made.
class PassGather {
  public:
    /// Takes the photons of pass number `pass`, whose seed is `seed`. What `c` and `plan` refer to must outlive this.
    /// Puts figures of the maps into `stats`. A stop leaves a cache with fewer records.
    PassGather(const SamplerContext& c, const RenderPlan& plan, std::int64_t pass, std::uint64_t seed, Photons photons,
               RenderStats& stats, const RunContext& context);
    PassGather(const PassGather&) = delete;
    PassGather& operator=(const PassGather&) = delete;

    /// A sample of what is seen at a point of the window.
    PixelSample sample(const Vec2& image, SampleSource& source) const { return gather_->sample(image, source); }

    /// What it asks. The maps may be without photons; where there is no cache, or no irradiance known beforehand: null.
    const GatherRays& rays() const { return *rays_; }
    const IrradianceCache* cache() const { return cache_ ? &*cache_ : nullptr; }
    /// Where light is gathered; null: everywhere.
    const GatherCoverage* coverage() const { return coverage_; }
    const IrradianceMap* irradiance() const { return irradiance_ ? &*irradiance_ : nullptr; }

    /// Says what the samples have shown of the cache, how noisy they are, and looks for spots that are not there.
    void report(RenderStats& stats, bool check_for_false_spots) const;

  private:
    /// At pilot photons, where these estimates are not too small to be made beforehand.
    void estimate_irradiance(const SamplerContext& c, const Radii& radii, std::uint64_t seed, RenderStats& stats,
                             const RunContext& context);
    /// By noise and by the number of rays of few samples: the same for any number of threads.
    double gather_rays_that_pay(const IrradianceCache* cache, GatherSamples samples) const;
    int rays_worth_their_time(const PlacedRecords& placed, const GatherSamples& samples,
                              const RunContext& context) const;

    ImageWindow window_;
    std::uint64_t seed_;
    const GatherCoverage* coverage_;
    PilotedMap global_, caustic_;
    OutlyingPhotons outlying_;
    std::optional<IrradianceMap> irradiance_;
    std::optional<DirectIrradianceCache> direct_irradiance_;
    std::optional<PilotSurroundings> caustic_surroundings_;
    std::optional<LobeTechniques> lobes_;
    std::optional<GatherRays> rays_;
    HotSpots spots_;
    std::optional<IrradianceCache> cache_;
    std::optional<FinalGather> gather_;
};

/// Who watches a pass: its photons, the paths that brought them, and what is made of them.
class PassObserver : public PhotonObserver {
  public:
    /// All photons of a pass are there.
    virtual void sampled(const Photons& photons) = 0;
    /// The maps and the irradiance cache of the pass are; `gather` lasts as long as the call.
    virtual void ready(const PassGather& gather) = 0;
};

} // namespace keyhole
