// Photons by light tracing: everywhere alike (standard photon mapping), or where they will be asked for.
#include "photonmap/emission.h"
#include "render/guides.h"
#include "render/memory_plan.h"
#include "render/photon_sampler.h"
#include "render/stage_clock.h"

#include <algorithm>

namespace keyhole {
namespace {

class EmissionSampler final : public PhotonSampler {
  public:
    EmissionSampler(const SamplerContext& context, bool by_importance) : c_(context), by_importance_(by_importance) {}

    Photons sample(std::uint64_t seed, RenderStats& stats, const RunContext& context) override {
        const MemoryPlan plan =
            plan_memory(c_.settings, by_importance_ ? ImportanceUse::guide : ImportanceUse::none, c_.caustics ? 2 : 1);
        Guides guides;
        if (by_importance_) guides = make_guides(c_, seed, plan.importons, stats, context);

        const StageClock clock(stats, "photons");
        EmittedPhotons photons =
            emit_photons(c_.scene, guides.both(),
                         {.paths = c_.settings.light_paths,
                          .photons = plan.photons,
                          .rule = c_.storage(),
                          .seed = seed,
                          .user_paths = by_importance_ ? LightGuides(c_.scene, c_.user_paths) : LightGuides()},
                         context);
        stats.values["light paths"] += static_cast<double>(photons.paths);
        stats.values["photons before storing"] += static_cast<double>(photons.arrivals);
        stats.photon_bytes = std::max<std::uint64_t>(stats.photon_bytes, photons.bytes + stats.importon_bytes);
        return photons;
    }

  private:
    SamplerContext c_;
    bool by_importance_;
};

} // namespace

std::unique_ptr<PhotonSampler> make_emission_sampler(const SamplerContext& context, bool by_importance) {
    return std::make_unique<EmissionSampler>(context, by_importance);
}

} // namespace keyhole
