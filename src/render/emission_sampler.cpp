// Photons by light tracing: everywhere alike (standard photon mapping), or where they will be asked for.
#include "photonmap/emission.h"
#include "photonmap/importance_tracing.h"
#include "render/memory_plan.h"
#include "render/photon_sampler.h"
#include "render/radii.h"
#include "render/stage_clock.h"

#include <algorithm>

namespace keyhole {
namespace {

class EmissionSampler final : public PhotonSampler {
  public:
    EmissionSampler(const SamplerContext& context, bool by_importance) : c_(context), by_importance_(by_importance) {}

    Photons sample(std::uint64_t seed, RenderStats& stats, const RunContext& context) override {
        const bool delta = c_.caustics;
        const MemoryPlan plan =
            plan_memory(c_.settings, by_importance_ ? ImportanceUse::guide : ImportanceUse::none, delta ? 2 : 1);
        std::unique_ptr<ImportanceGuide> global, caustic;
        // A guide needs fewer importons than power that is divided by what they say.
        if (by_importance_)
            make_guides(seed, std::min<std::int64_t>(plan.importons, 100'000), global, caustic, stats, context);
        const EmissionGuide guide{global.get(), caustic.get()};

        const StageClock clock(stats, "photons");
        EmittedPhotons photons = emit_photons(c_.scene, guide,
                                              {.paths = c_.settings.light_paths,
                                               .photons = plan.photons,
                                               .max_scatterings = static_cast<int>(c_.settings.max_depth),
                                               .seed = seed},
                                              context);
        stats.values["light paths"] = static_cast<double>(photons.paths);
        stats.values["photons before storing"] = static_cast<double>(photons.arrivals);
        stats.photon_bytes = std::max<std::uint64_t>(stats.photon_bytes, photons.bytes + stats.importon_bytes);
        return photons;
    }

  private:
    void make_guides(std::uint64_t seed, std::int64_t samples, std::unique_ptr<ImportanceGuide>& global,
                     std::unique_ptr<ImportanceGuide>& caustic, RenderStats& stats, const RunContext& context) const {
        const StageClock clock(stats, "importance");
        const bool delta = c_.caustics;
        Importons importons = trace_importance(c_.scene,
                                               {.samples = samples,
                                                .at_d1 = delta,
                                                .max_scatterings = static_cast<int>(c_.settings.max_depth),
                                                .seed = seed},
                                               context);
        const float radius = Radii(c_.scene).importance;
        const auto make = [&](std::vector<Photon>&& from) {
            const PhotonMap map(std::move(from));
            auto guide = std::make_unique<ImportanceGuide>(map, radius, c_.patches, context);
            stats.importons += map.photons().size();
            const std::size_t waiting = importons.first.capacity() * sizeof(Photon);
            stats.photon_bytes = std::max<std::uint64_t>(stats.photon_bytes, map.bytes() + guide->bytes() + waiting);
            return guide;
        };
        stats.importons = 0;
        global = make(std::move(importons.second));
        if (delta) caustic = make(std::move(importons.first));
        stats.importon_bytes = global->bytes() + (caustic ? caustic->bytes() : 0);
    }

    SamplerContext c_;
    bool by_importance_;
};

} // namespace

std::unique_ptr<PhotonSampler> make_emission_sampler(const SamplerContext& context, bool by_importance) {
    return std::make_unique<EmissionSampler>(context, by_importance);
}

} // namespace keyhole
