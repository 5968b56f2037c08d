// --method pm, ipm: photons by light tracing, everywhere alike (standard photon mapping), or where they will be asked
// for.
#include "methods/method.h"
#include "methods/photons/learn_light_paths.h"
#include "methods/photons/memory_plan.h"
#include "methods/photons/photon_sampler.h"
#include "methods/photons/radii.h"
#include "methods/photons/trials/trials.h"
#include "photonmap/emission.h"
#include "session/stage_clock.h"

#include <algorithm>
#include <memory>
#include <numeric>

namespace keyhole {
namespace {

/// Effective share of photons that are seen, from which on importance is left out: to ask for it and to learn where
/// light paths begin takes three quarters of a light path's time, and it would let nearly all photons in.
constexpr double kNearlyAll = 0.6;
/// Share of the visible power in caustics that were not found from the eye, from which on light paths are kept for
/// them, and from which on all begin by power.
constexpr double kHidden = 0.01, kMostlyHidden = 0.33;
/// Second moment of what begins as it was learned, over that by power, from which on it doesn't pay. The trial finds
/// 0.08 to 0.13 in the dining-room, and 5 to 8 where the sun shines through glass.
constexpr double kDoesNotPay = 2;

/// A guide needs fewer importons than power that is divided by what they say.
constexpr std::int64_t kMostImportons = 100'000;

/// Importance guides of both maps.
struct Guides {
    std::unique_ptr<ImportanceGuide> global, caustic; ///< null: there is none

    EmissionGuide both() const { return {global.get(), caustic.get()}; }
};

/// Traces `importons` eye paths, or as many as guides need, and makes guides of them, that of the caustic map where
/// there is to be one. Puts their figures into `stats`.
Guides make_guides(const SamplerContext& c, std::uint64_t seed, std::int64_t importons, RenderStats& stats,
                   const RunContext& context) {
    const StageClock clock(stats, stages::importance);
    Importons traced =
        trace_importance(c.scene, c.importance_tracing(std::min(importons, kMostImportons), seed), context);
    const float radius = Radii(c.scene).importance;
    stats.importons = 0;
    const auto make = [&](std::vector<Photon>&& from) {
        const PhotonMap map(std::move(from));
        auto guide = std::make_unique<ImportanceGuide>(map, radius, c.patches, &c.scene, context);
        stats.importons += map.photons().size();
        const std::size_t waiting = traced.first.capacity() * sizeof(Photon);
        stats.photon_bytes = std::max<std::uint64_t>(stats.photon_bytes, map.bytes() + guide->bytes() + waiting);
        return guide;
    };
    Guides guides;
    guides.global = make(std::move(traced.second));
    if (c.caustics) guides.caustic = make(std::move(traced.first));
    stats.importon_bytes = guides.global->bytes() + (guides.caustic ? guides.caustic->bytes() : 0);
    return guides;
}

class EmissionSampler final : public PhotonSampler {
  public:
    EmissionSampler(const SamplerContext& context, bool by_importance) : c_(context), by_importance_(by_importance) {}

    Photons sample(std::uint64_t seed, RenderStats& stats, const RunContext& context) override {
        const Guides guides = by_importance_ ? guide(seed, stats, context) : Guides();
        const MemoryPlan plan = memory();
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
        stats.photon_quality.cut_off = photons.cut;
        stats.values["photons before storing"] += static_cast<double>(photons.arrivals);
        stats.photon_bytes = std::max<std::uint64_t>(stats.photon_bytes, photons.bytes + stats.importon_bytes);
        return photons;
    }

  private:
    MemoryPlan memory() const {
        return plan_memory(c_.settings, by_importance_ ? ImportanceUse::guide : ImportanceUse::none,
                           c_.caustics ? 2 : 1);
    }

    /// What is to know before light is traced by importance. None, in this pass and those that follow, where the first
    /// finds that importance isn't worth its time.
    Guides guide(std::uint64_t seed, RenderStats& stats, const RunContext& context) {
        Guides guides = make_guides(c_, seed, memory().importons, stats, context);
        if (learned_) return guides;
        const double seen =
            share_of_photons_seen(c_.scene, guides.both(), c_.storage(), c_.settings.light_paths, seed, context);
        stats.values["photons that are seen, effective share"] = seen;
        by_importance_ = seen < kNearlyAll || !c_.user_paths.empty();
        if (!by_importance_) return {};
        learned_ = learn_light_paths(c_, stats, context);
        if (!learned_->emission) return guides;
        EmissionTrial trial = try_emission(c_.scene, guides.both(), c_.storage(), *learned_->emission, seed, context);
        const double hidden = std::accumulate(trial.hidden.begin(), trial.hidden.end(), 0.0);
        stats.values["second moment of photons as learned"] = trial.second_moment;
        stats.values["caustics that nothing was learned of"] = hidden;
        if (trial.second_moment > kDoesNotPay || hidden > kMostlyHidden)
            *learned_ = {};
        else if (hidden > kHidden)
            learned_->emission->add_hidden(trial.hidden);
        return guides;
    }

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
