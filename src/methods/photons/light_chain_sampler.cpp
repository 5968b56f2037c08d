// --method pss: photons of chains in primary sample space whose states are light sub-paths (Hachisuka and Jensen 2011),
// seeking importance.
#include "methods/chain_report.h"
#include "methods/method.h"
#include "methods/photons/guides.h"
#include "methods/photons/memory_plan.h"
#include "methods/photons/photon_report.h"
#include "methods/photons/photon_sampler.h"
#include "methods/primary_report.h"
#include "photonmap/light_chains/light_chains.h"
#include "session/stage_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

class LightChainSampler final : public PhotonSampler {
  public:
    explicit LightChainSampler(const SamplerContext& context) : c_(context) {}

    Photons sample(std::uint64_t seed, RenderStats& stats, const RunContext& context) override {
        const Settings& s = c_.settings;
        const MemoryPlan plan = plan_memory(s, ImportanceUse::guide, c_.caustics ? 2 : 1);
        const Guides guides = make_guides(c_, seed, plan.importons, stats, context);
        const LightChainOptions options{.samples = s.brightness_samples,
                                        .chains = s.chains,
                                        .mutations = s.mutations,
                                        .photons = plan.photons,
                                        .p_large = s.p_large.value,
                                        .mis_of_large_steps = s.large_step_mis,
                                        .rule = c_.storage(),
                                        .seed = seed};
        LightChainStart start;
        {
            const StageClock clock(stats, stages::brightness);
            start = start_light_chains(c_.scene, guides.both(), options, context);
        }
        stats.values["brightness samples"] = static_cast<double>(start.samples);
        const StageClock clock(stats, stages::photons_of_chains);
        LightChainPhotons photons = run_light_chains(c_.scene, guides.both(), start, options, context);
        stats.photon_bytes = std::max<std::uint64_t>(stats.photon_bytes, photons.bytes + stats.importon_bytes);
        if (photons.chains > 0) report(photons, stats);
        cut_outliers(photons, s.passes, stats);
        return photons;
    }

    void finish(RenderStats& stats) override {
        warn_of_broken(stats, broken_);
        if (target_.standard_error() > 0.05 * target_.mean())
            stats.warn(Doubt::photons, fmt::format("the visible power of light sub-paths is known to {:.0f} % only "
                                                   "(standard error): raise brightness_samples",
                                                   100 * target_.standard_error() / target_.mean()));
    }

  private:
    void report(const LightChainPhotons& photons, RenderStats& stats) {
        RenderStats pass;
        report_steps(photons.counts, photons.chains, pass);
        add_pass(stats, std::move(pass));
        report_large_steps(photons.rule, photons.p_large, stats);
        target_.merge(photons.target);
        stats.values["visible power of light sub-paths"] = target_.mean();
        stats.values["visible power of light sub-paths, error"] = target_.standard_error();
        broken_ += photons.broken;
    }

    SamplerContext c_;
    RunningStats target_; // over all passes
    std::uint64_t broken_ = 0;
};

} // namespace

constinit const Method methods::pss{
    .name = "pss",
    .help = "photons of chains in primary sample space, over light sub-paths that seek importance",
    .keeps_photons = true,
    .asks_for_direct_light = true,
    .importance = ImportanceUse::guide,
    .render = render_photons,
    .make_sampler = [](const SamplerContext& c) -> std::unique_ptr<PhotonSampler> {
        return std::make_unique<LightChainSampler>(c);
    }};

} // namespace keyhole
