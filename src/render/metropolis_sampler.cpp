// Metropolis photon sampling (Fan, Chenney, Lai 2005): stage one, and stage two as chains over whole paths.
#include "photonmap/importance_tracing.h"
#include "photonmap/photon_sampling.h"
#include "render/chain_report.h"
#include "render/memory_plan.h"
#include "render/photon_sampler.h"
#include "render/radii.h"
#include "render/stage_clock.h"
#include "sampling/proposals/tuning.h"

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
    stats.values["photons with power by drawing eye sides"] = static_cast<double>(t.untrusted);
    stats.values["eye sides drawn"] = static_cast<double>(t.draws);
}

PowerRule power_rule(const Settings& settings) {
    return settings.power == "reciprocal" ? PowerRule::reciprocal
           : settings.power == "literal"  ? PowerRule::literal
                                          : PowerRule::marginal;
}

class MetropolisSampler final : public PhotonSampler {
  public:
    explicit MetropolisSampler(const SamplerContext& context)
        : c_(context), rule_(power_rule(context.settings)), set_(context.path_set()),
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
        // Stages whose times follow from different settings, so that what others cost can be foreseen.
        std::optional<StageClock> clock(std::in_place, stats, "seeds");
        const ChainSeeds seeds = choose_chain_seeds(c_.scene, first, one, s.chains);
        clock.emplace(stats, "importance");
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

        clock.emplace(stats, "tuning");
        const ProposalContext proposals{&c_.scene, set_, static_cast<int>(s.max_depth)};
        // Told by the seeds of chains that carry no light: those of the others are independent of it.
        const Settings tuned = tuned_proposals(proposals, s, c_.user_paths, seeds.scouts, first.seed);
        const ChainMixtures mixtures(proposals, tuned, c_.user_paths);
        clock.emplace(stats, "photons");
        const std::size_t caustic = c_.caustics ? caustic_share(one, plan.photons) : 0;
        SampledPhotons photons = sample_photons(seeds, mixtures.mixture,
                                                {.global = &at_d2,
                                                 .caustic = &at_d1,
                                                 .rule = rule_,
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
    PowerRule rule_;
    PathSet set_;
    GuidedPaths guides_;
    ChainReports reports_;
};

} // namespace

std::unique_ptr<PhotonSampler> make_metropolis_sampler(const SamplerContext& context) {
    return std::make_unique<MetropolisSampler>(context);
}

} // namespace keyhole
