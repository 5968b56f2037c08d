// --method cps: photons of chains over whole paths and of independent light paths in one map, weighed by the balance
// heuristic; docs/photon-maps.md.
#include "methods/chain_report.h"
#include "methods/method.h"
#include "methods/photons/chain_importance.h"
#include "methods/photons/learn_light_paths.h"
#include "methods/photons/memory_plan.h"
#include "methods/photons/radii.h"
#include "methods/photons/trials/trials.h"
#include "photonmap/emission.h"
#include "photonmap/photon_sampling.h"
#include "photonmap/power.h"
#include "sampling/proposals/tuning.h"
#include "session/stage_clock.h"

#include <algorithm>

namespace keyhole {
namespace {

/// With some work for both techniques.
class CombinedSampler final : public PhotonSampler {
  public:
    CombinedSampler(const SamplerContext& context, const WorkShares& shares)
        : c_(context), shares_(shares),
          chains_(static_cast<std::int64_t>(shares.chains * static_cast<double>(c_.settings.mutations))),
          light_paths_(static_cast<std::int64_t>((1 - shares.chains) * static_cast<double>(c_.settings.light_paths))),
          brightness_samples_(std::max<std::int64_t>(
              kLeastSamples,
              static_cast<std::int64_t>(shares.chains * static_cast<double>(c_.settings.brightness_samples)))),
          set_(c_.path_set()), guides_(c_.scene, c_.user_paths, set_, static_cast<int>(c_.settings.max_depth)),
          user_paths_(c_.scene, c_.user_paths) {}

    Photons sample(std::uint64_t seed, RenderStats& stats, const RunContext& context) override {
        StageOneSettings first = stage_one_settings(c_, seed, guides_);
        first.samples = brightness_samples_;
        first.error /= shares_.chains; // it counts as chains do
        const StageOne one = reports_.measure_brightness(c_.scene, first, stats, context);
        std::optional<StageClock> clock(std::in_place, stats, stages::seeds);
        ChainSeeds seeds;
        if (one.brightness.mean() > 0) seeds = choose_chain_seeds(c_.scene, first, one, c_.settings.chains);
        clock.emplace(stats, stages::importance);
        const MemoryPlan plan = plan_memory(c_.settings, ImportanceUse::both, c_.caustics ? 2 : 1);
        const ChainImportance importance(c_, seed, plan.importons, context);
        importance.report(stats);
        const float radius = Radii(c_.scene).importance;
        const ImportanceGuide global(importance.at_d2.map(), radius, c_.patches, &c_.scene, context);
        const ImportanceGuide caustic(importance.at_d1.map(), radius, c_.patches, &c_.scene, context);
        stats.importon_bytes += global.bytes() + caustic.bytes();
        clock.reset();
        if (!learned_) learned_ = learn_light_paths(c_, stats, context);

        const EmissionGuide guide{&global, c_.caustics ? &caustic : nullptr};
        const double steps = static_cast<double>(chains_), paths = static_cast<double>(light_paths_);
        const double odds = seeds.brightness > 0 ? steps / (shares_.correlation * paths * seeds.brightness) : 0;
        const TechniqueWeights weights(guide, {&user_paths_, learned_->emission_or_null()}, odds);
        const std::size_t of_caustic = one.brightness.mean() > 0 ? photons_for_caustic(c_, one, plan.photons) : 0;
        MapStores stores({plan.photons - of_caustic, of_caustic}, unit_of_power(c_.scene), {}, seed);
        const Pass pass{seed, plan.photons, weights, stores};
        if (odds > 0) run_chains(seeds, importance, pass, stats, context);
        return trace_light(guide, pass, stats, context);
    }

    void finish(RenderStats& stats) override { reports_.finish(stats); }

  private:
    static constexpr std::int64_t kLeastSamples = 1000; // of stage one
    static constexpr double kPathsOfStep = 3;           // light paths that take as long as a step of a chain

    struct Pass {
        std::uint64_t seed;
        std::size_t photons; ///< that the stores hold
        const TechniqueWeights& weights;
        MapStores& stores;
    };

    void run_chains(const ChainSeeds& seeds, const ChainImportance& importance, const Pass& pass, RenderStats& stats,
                    const RunContext& context) {
        std::optional<StageClock> clock(std::in_place, stats, stages::tuning);
        const ProposalContext proposals{&c_.scene, set_, static_cast<int>(c_.settings.max_depth), &c_.user_paths};
        Settings s = c_.settings;
        s.mutations = chains_;
        const ChainMixtures mixtures(proposals, tuned_proposals(proposals, s, seeds.pilots, pass.seed));
        clock.emplace(stats, stages::photons_of_chains);
        DepositOptions deposit = importance.deposit(c_);
        deposit.weights = &pass.weights;
        const PhotonChains chains = run_photon_chains(seeds, mixtures.mixture, deposit,
                                                      {.mutations = chains_,
                                                       .global_photons = pass.photons,
                                                       .caustic_photons = 0,
                                                       .seed = pass.seed,
                                                       .control = mixtures.control_or_null()},
                                                      pass.stores, leave_time_to_light_paths(context));
        pass.stores.settle(chains.global_scale, chains.caustic_scale, emission_scale(light_paths_));
        report_power(chains.tally, stats);
        reports_.add(mixtures.mixture, chains.chains, stats);
    }

    /// Were chains to take all the time, few light paths would stand in for all that the weights count on.
    RunContext leave_time_to_light_paths(const RunContext& context) const {
        const double of_chains = kPathsOfStep * shares_.chains;
        return c_.with_reserve(context, (1 - shares_.chains) / (1 - shares_.chains + of_chains));
    }

    Photons trace_light(const EmissionGuide& guide, const Pass& pass, RenderStats& stats, const RunContext& context) {
        const StageClock clock(stats, stages::photons_of_light_paths);
        const Emission emission = emit_photons(c_.scene, guide,
                                               {.paths = light_paths_,
                                                .photons = pass.photons,
                                                .rule = c_.storage(),
                                                .seed = pass.seed,
                                                .user_paths = user_paths_,
                                                .learned = learned_->emission_or_null(),
                                                .weights = &pass.weights,
                                                .observer = c_.observer},
                                               pass.stores, context);
        stats.values["light paths"] += static_cast<double>(emission.paths);
        stats.values["photons before storing"] += static_cast<double>(emission.arrivals);
        stats.photon_bytes =
            std::max<std::uint64_t>(stats.photon_bytes, pass.stores.bytes_held() + stats.importon_bytes);
        return pass.stores.release(emission.scale(), emission.scale());
    }

    SamplerContext c_;
    WorkShares shares_;
    std::int64_t chains_, light_paths_, brightness_samples_; // steps, paths, samples of a pass
    PathSet set_;
    GuidedPaths guides_;
    LightGuides user_paths_;
    std::optional<LearnedLightPaths> learned_; ///< of which p(X) knows where light paths begin
    ChainReports reports_;
};

/// Decides in the first pass, and leaves the work to the one technique where the other is worth nothing.
class ShareOfChains final : public PhotonSampler {
  public:
    explicit ShareOfChains(const SamplerContext& context) : c_(context) {}

    Photons sample(std::uint64_t seed, RenderStats& stats, const RunContext& context) override {
        if (!sampler_) decide(stats, context);
        return sampler_->sample(seed, stats, context);
    }
    void finish(RenderStats& stats) override {
        if (sampler_) sampler_->finish(stats);
    }

  private:
    void decide(RenderStats& stats, const RunContext& context) {
        std::optional<WorkShares> shares;
        const std::optional<double> given = c_.settings.chain_share.value;
        if (given && (*given == 0 || *given == 1)) shares = {*given, 1};
        if (!shares && c_.shares != nullptr) shares = *c_.shares;
        if (!shares) {
            static constexpr Stage kTrial{"trial of chains and light paths"};
            const StageClock clock(stats, kTrial);
            shares = try_shares(c_, context);
            if (c_.shares != nullptr) *c_.shares = shares;
        }
        stats.values["share of chains"] = shares->chains;
        stats.values["steps that count as one"] = shares->correlation;
        sampler_ = shares->chains <= 0   ? methods::ipm.make_sampler(c_)
                   : shares->chains >= 1 ? methods::mps.make_sampler(c_)
                                         : std::make_unique<CombinedSampler>(c_, *shares);
    }

    SamplerContext c_;
    std::unique_ptr<PhotonSampler> sampler_;
};

} // namespace

constinit const Method methods::cps{.name = "cps",
                                    .help = "photons of chains and of light paths, weighed by the balance heuristic",
                                    .keeps_photons = true,
                                    .follows_user_paths = true,
                                    .asks_for_direct_light = true,
                                    .importance = ImportanceUse::both,
                                    .render = render_photons,
                                    .make_sampler = [](const SamplerContext& c) -> std::unique_ptr<PhotonSampler> {
                                        return std::make_unique<ShareOfChains>(c);
                                    }};

} // namespace keyhole
