// --method pm, ipm: photons by light tracing, everywhere alike (standard photon mapping), or where they will be asked
// for.
#include "methods/method.h"
#include "methods/photons/guides.h"
#include "methods/photons/learn_light_paths.h"
#include "methods/photons/memory_plan.h"
#include "methods/photons/photon_sampler.h"
#include "photonmap/emission.h"
#include "session/stage_clock.h"

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
        if (by_importance_ && !learned_) learned_ = learn_light_paths(c_, stats, context);

        const StageClock clock(stats, stages::photons_of_light_paths);
        EmittedPhotons photons =
            emit_photons(c_.scene, guides.both(),
                         {.paths = c_.settings.light_paths,
                          .photons = plan.photons,
                          .rule = c_.storage(),
                          .seed = seed,
                          .user_paths = by_importance_ ? LightGuides(c_.scene, c_.user_paths) : LightGuides(),
                          .learned = learned_ ? learned_->emission_or_null() : nullptr,
                          .scattering = learned_ ? learned_->scattering_or_null() : nullptr,
                          .cut_outliers = by_importance_ && c_.settings.passes == 1,
                          .observer = c_.observer},
                         context);
        photons.everywhere = true;
        stats.values["light paths"] += static_cast<double>(photons.paths);
        if (photons.cut > 0) stats.values["photon power, share cut off outliers"] = photons.cut;
        stats.values["photons before storing"] += static_cast<double>(photons.arrivals);
        stats.photon_bytes = std::max<std::uint64_t>(stats.photon_bytes, photons.bytes + stats.importon_bytes);
        return photons;
    }

  private:
    SamplerContext c_;
    bool by_importance_;
    std::optional<LearnedLightPaths> learned_;
};

} // namespace

constinit const Method methods::ipm{.name = "ipm",
                                    .help = "photon mapping with photons stored where they are seen",
                                    .keeps_photons = true,
                                    .follows_user_paths = true,
                                    .asks_for_direct_light = true,
                                    .importance = ImportanceUse::guide,
                                    .trial = {.share = 0.30, .by_work = true, .doubt = 1.4},
                                    .render = render_photons,
                                    .make_sampler = [](const SamplerContext& c) -> std::unique_ptr<PhotonSampler> {
                                        return std::make_unique<EmissionSampler>(c, true);
                                    }};

constinit const Method methods::pm{.name = "pm",
                                   .help = "standard photon mapping (Jensen 2001)",
                                   .keeps_photons = true,
                                   .asks_for_direct_light = true,
                                   .render = render_photons,
                                   .make_sampler = [](const SamplerContext& c) -> std::unique_ptr<PhotonSampler> {
                                       return std::make_unique<EmissionSampler>(c, false);
                                   }};

} // namespace keyhole
