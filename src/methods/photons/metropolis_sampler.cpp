// --method mps: Metropolis photon sampling (Fan, Chenney, Lai 2005): stage one, and stage two as chains over whole
// paths.
#include "methods/chain_report.h"
#include "methods/method.h"
#include "methods/photons/chain_importance.h"
#include "methods/photons/memory_plan.h"
#include "methods/photons/photon_report.h"
#include "methods/sample_report.h"
#include "photonmap/photon_sampling.h"
#include "sampling/proposals/tuning.h"
#include "session/stage_clock.h"

#include <algorithm>
#include <optional>

namespace keyhole {
namespace {

class MetropolisSampler final : public PhotonSampler {
  public:
    explicit MetropolisSampler(const SamplerContext& context)
        : c_(context), set_(context.path_set()),
          guides_(context.scene, context.user_paths, set_, static_cast<int>(context.settings.max_depth)) {}

    Photons sample(std::uint64_t seed, RenderStats& stats, const RunContext& context) override {
        const StageOneSettings first = stage_one_settings(c_, seed, guides_);
        const StageOne one = reports_.measure_brightness(c_.scene, first, stats, context);
        if (!(one.brightness.mean() > 0)) return {};
        return run_chains(first, one, stats, context);
    }

    void finish(RenderStats& stats) override {
        reports_.finish(stats);
        report_lost_caustics(c_.scene, stats);
    }

  private:
    /// Chains from the seeds of stage one, photons with the power that the rule gives them.
    Photons run_chains(const StageOneSettings& first, const StageOne& one, RenderStats& stats,
                       const RunContext& context) {
        const Settings& s = c_.settings;
        // Stages whose times follow from different settings, so that what others cost can be predicted.
        std::optional<StageClock> clock(std::in_place, stats, stages::seeds);
        const ChainSeeds seeds = choose_chain_seeds(c_.scene, first, one, s.chains);
        clock.emplace(stats, stages::importance);
        const MemoryPlan plan = plan_memory(s, ImportanceUse::beside, c_.caustics ? 2 : 1);
        const ChainImportance importance(c_, first.seed, plan.importons, context);
        importance.report(stats);

        clock.emplace(stats, stages::tuning);
        const ProposalContext proposals{&c_.scene, set_, static_cast<int>(s.max_depth), &c_.user_paths};
        // Told by the seeds of chains that carry no light: those of the others are independent of it.
        const Settings tuned = tuned_proposals(proposals, s, seeds.pilots, first.seed);
        const ChainMixtures mixtures(proposals, tuned);
        clock.emplace(stats, stages::photons_of_chains);
        const std::size_t caustic = photons_for_caustic(c_, one, plan.photons);
        SampledPhotons photons = sample_photons(seeds, mixtures.mixture, importance.deposit(c_),
                                                {.mutations = s.mutations,
                                                 .global_photons = plan.photons - caustic,
                                                 .caustic_photons = caustic,
                                                 .seed = first.seed,
                                                 .control = mixtures.control_or_null()},
                                                context);
        stats.photon_bytes = std::max<std::uint64_t>(stats.photon_bytes, photons.bytes + stats.importon_bytes);
        report_power(photons.tally, stats);
        cut_outliers(photons, s.passes, stats);
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
                                    .trial = {.share = 0.16, .by_work = true, .doubt = 10, .needless_below = 0.3},
                                    .render = render_photons,
                                    .make_sampler = [](const SamplerContext& c) -> std::unique_ptr<PhotonSampler> {
                                        return std::make_unique<MetropolisSampler>(c);
                                    }};

} // namespace keyhole
