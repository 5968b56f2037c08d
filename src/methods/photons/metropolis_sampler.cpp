// --method mps: Metropolis photon sampling (Fan, Chenney, Lai 2005): stage one, and stage two as chains over whole
// paths.
#include "methods/chain_report.h"
#include "methods/method.h"
#include "methods/photons/memory_plan.h"
#include "methods/photons/photon_sampler.h"
#include "methods/photons/radii.h"
#include "photonmap/importance/importance_tracing.h"
#include "photonmap/photon_sampling.h"
#include "sampling/proposals/tuning.h"
#include "session/stage_clock.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace keyhole {
namespace {

/// Each photon weighs the same where it is asked, so the maps share the ceiling as they share the light.
std::size_t caustic_share(const StageOne& one, std::size_t photons) {
    return photons_for_caustic(one.caustic.mean() / one.brightness.mean(), photons);
}

void report_power(const PathDepositor::Tally& t, RenderStats& stats) {
    stats.values["share of power without importance"] = t.total > 0 ? t.lost / t.total : 0;
    // How unequal photons are: what the rule in force makes of them, and what MPS 3.2 would.
    const auto variation = [](const RunningStats& s) { return s.mean() > 0 ? std::sqrt(s.variance()) / s.mean() : 0; };
    stats.values["photon power, coefficient of variation"] = variation(t.power);
    stats.values["photon power, coefficient of variation, literal"] = variation(t.literal_power);
    stats.values["photons with power by drawing camera sub-paths"] = static_cast<double>(t.untrusted);
    stats.values["camera sub-paths drawn"] = static_cast<double>(t.draws);
}

class MetropolisSampler final : public PhotonSampler {
  public:
    explicit MetropolisSampler(const SamplerContext& context)
        : c_(context), set_(context.path_set()),
          guides_(context.scene, context.user_paths, set_, static_cast<int>(context.settings.max_depth)) {}

    Photons sample(std::uint64_t seed, RenderStats& stats, const RunContext& context) override {
        const StageOneSettings first{.set = set_,
                                     .max_scatterings = static_cast<int>(c_.settings.max_depth),
                                     .samples = c_.settings.brightness_samples,
                                     .error = c_.settings.brightness_error,
                                     .seed = seed,
                                     .guides = c_.user_paths.empty() ? nullptr : &guides_};
        const StageOne one = reports_.measure_brightness(c_.scene, first, stats, context);
        if (!(one.brightness.mean() > 0)) return {};
        return run_chains(first, one, stats, context);
    }

    void finish(RenderStats& stats) override { reports_.finish(stats); }

  private:
    /// Chains from the seeds of stage one, photons with the power that the rule gives them.
    Photons run_chains(const StageOneSettings& first, const StageOne& one, RenderStats& stats,
                       const RunContext& context) {
        const Settings& s = c_.settings;
        // Stages whose times follow from different settings, so that what others cost can be predicted.
        std::optional<StageClock> clock(std::in_place, stats, stages::seeds);
        const ChainSeeds seeds = choose_chain_seeds(c_.scene, first, one, s.chains);
        clock.emplace(stats, stages::importance);
        const bool delta = c_.caustics;
        const MemoryPlan plan = plan_memory(s, ImportanceUse::beside, delta ? 2 : 1);
        Importons importons = trace_importance(c_.scene,
                                               {.samples = plan.importons,
                                                .at_d1 = delta,
                                                .max_scatterings = first.max_scatterings,
                                                .seed = first.seed,
                                                .weight = c_.weight},
                                               context);
        const ImportanceOptions options{.k = 50, .max_radius = Radii(c_.scene).importance, .patches = &c_.patches};
        const ImportanceMap at_d1(std::move(importons.first), options);
        const ImportanceMap at_d2(std::move(importons.second), options);
        stats.importons = at_d1.map().photons().size() + at_d2.map().photons().size();
        stats.importon_bytes = at_d1.bytes() + at_d2.bytes();

        clock.emplace(stats, stages::tuning);
        const ProposalContext proposals{&c_.scene, set_, static_cast<int>(s.max_depth), &c_.user_paths};
        // Told by the seeds of chains that carry no light: those of the others are independent of it.
        const Settings tuned = tuned_proposals(proposals, s, seeds.pilots, first.seed);
        const ChainMixtures mixtures(proposals, tuned);
        clock.emplace(stats, stages::photons_of_chains);
        const std::size_t caustic = c_.caustics ? caustic_share(one, plan.photons) : 0;
        SampledPhotons photons = sample_photons(seeds, mixtures.mixture,
                                                {.global = &at_d2,
                                                 .caustic = &at_d1,
                                                 .rule = s.power,
                                                 .scene = &c_.scene,
                                                 .set = set_,
                                                 .max_scatterings = static_cast<int>(s.max_depth)},
                                                {.mutations = s.mutations,
                                                 .global_photons = plan.photons - caustic,
                                                 .caustic_photons = caustic,
                                                 .seed = first.seed,
                                                 .control = mixtures.control_or_null()},
                                                context);
        stats.photon_bytes = std::max<std::uint64_t>(stats.photon_bytes, photons.bytes + stats.importon_bytes);
        report_power(photons.tally, stats);
        reports_.add(mixtures.mixture, photons.chains, stats);
        return photons;
    }

    SamplerContext c_;
    PathSet set_;
    GuidedPaths guides_;
    ChainReports reports_;
};

} // namespace

constinit const Method methods::mps{.name = "mps",
                                    .help = "Metropolis photon sampling: photons of chains over whole paths",
                                    .keeps_photons = true,
                                    .follows_user_paths = true,
                                    .asks_for_direct_light = true,
                                    .importance = ImportanceUse::beside,
                                    .trial = {.share = 0.16, .by_work = true, .doubt = 2},
                                    .render = render_photons,
                                    .make_sampler = [](const SamplerContext& c) -> std::unique_ptr<PhotonSampler> {
                                        return std::make_unique<MetropolisSampler>(c);
                                    }};

} // namespace keyhole
