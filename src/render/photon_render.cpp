// The methods that render from photon maps: pass by pass a sampler, the maps, the gather.
#include "core/interruptible.h"
#include "render/methods.h"
#include "render/pass_gather.h"
#include "render/pass_seed.h"
#include "render/photon_file.h"
#include "render/photon_report.h"
#include "render/photon_sampler.h"
#include "render/pixels.h"
#include "render/plan.h"
#include "render/sample_report.h"
#include "render/sampler_trial.h"
#include "render/stage_clock.h"
#include "render/work.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

/// What `auto` stands for in this scene; says so.
std::string choose_method(const SamplerContext& c, RenderStats& stats, const RunContext& context) {
    const StageClock clock(stats, "trial of samplers");
    const SamplerTrial trial = try_samplers(c, context);
    std::string method(trial.best());
    const double better = std::min(trial.emission, trial.metropolis);
    stats.remarks.push_back(
        std::isfinite(better)
            ? fmt::format("method {} chosen: for the same error ipm would need {:.2g} times the work, mps {:.2g} times",
                          method, trial.emission / better, trial.metropolis / better)
            : "method ipm chosen: no light that photon maps would hold was found in a trial");
    return method;
}

/// Where no light is that photon maps would hold.
class NoPhotons final : public PhotonSampler {
  public:
    Photons sample(std::uint64_t /*seed*/, RenderStats& /*stats*/, const RunContext& /*context*/) override {
        return {};
    }
};

std::unique_ptr<PhotonSampler> make_sampler(const SamplerContext& c, const RenderPlan& plan, RenderStats& stats,
                                            const RunContext& context) {
    if (!c.settings.load_map.empty()) return make_file_sampler(c);
    if (!plan.photons) return std::make_unique<NoPhotons>();
    const std::string method = c.settings.method == "auto" ? choose_method(c, stats, context) : c.settings.method;
    stats.method = method;
    if (method == "mps") return make_metropolis_sampler(c);
    if (method == "pss") return make_light_chain_sampler(c);
    return make_emission_sampler(c, method == "ipm");
}

/// The weights of pixels, where the user asked for them and something can follow them.
std::optional<ImageWeight> weigh_pixels(const SamplerContext& c, const RenderPlan& plan, RenderStats& stats,
                                        const RunContext& context) {
    const Settings& s = c.settings;
    if (!s.equalise || !plan.photons || s.method == "pm" || !s.load_map.empty()) return std::nullopt;
    const StageClock clock(stats, "brightness of pixels");
    return measure_image_weight(c.scene, static_cast<int>(s.max_depth), static_cast<std::uint64_t>(s.seed), context);
}

/// Renders one pass after the other.
class Passes {
  public:
    /// `for_gather`: as Share's.
    Passes(const SamplerContext& c, const RenderPlan& plan, PhotonSampler& sampler, Work& work, double for_gather,
           RenderStats& stats)
        : c_(c), plan_(plan), sampler_(sampler), work_(work), for_gather_(for_gather), stats_(stats) {}

    /// All passes that there are units of.
    /// @throws Interrupted if there is nothing to show.
    void run(const RunContext& context) {
        next_ = work_.take(context);
        try {
            while (next_ && run_pass(work_.pass_of(*next_), context)) {
            }
        } catch (const Interrupted&) {
            if (work_.is_first()) throw; // what the pass before left is a picture
        }
    }
    /// The same by a crew: each helps with every pass, whether or not it gets to sample pixels from it.
    void run_together(const RunContext& context) {
        RunContext together = context;
        together.crew = work_.crew();
        try {
            next_ = work_.take(context);
            for (auto pass = work_.pass_from(0); pass; pass = work_.pass_from(*pass + 1))
                if (!run_pass(*pass, together)) break;
        } catch (const TeamLost&) { // whoever collects what is done says so
        }
    }
    const RunningStats& luminance() const { return luminance_; }
    bool has_saved_photons() const { return saved_; }

  private:
    /// Returns whether to go on.
    bool run_pass(std::int64_t pass, const RunContext& context) {
        const std::uint64_t seed = seed_of_pass(c_.settings, pass);
        RunContext early = context;
        early.reserve += for_gather_;
        Photons photons = sampler_.sample(seed, stats_, early);
        if (pass == 0) save(photons, context);
        // The photons of a pass that was cut short are good for a first picture, not for one that is there.
        if (early.stopped() && (context.crew != nullptr || !work_.is_first())) return false;
        report_photons(photons, stats_);
        std::optional<PassGather> gather;
        {
            const StageClock clock(stats_, "cache");
            gather.emplace(c_, plan_, pass, seed, std::move(photons), stats_, context);
        }
        if (context.crew != nullptr && context.stopped()) return false;
        const StageClock clock(stats_, "gather");
        const bool whole = sample_rounds(*gather, pass, context.alone());
        gather->report(stats_);
        return whole || context.crew != nullptr; // a crew ends where all can agree on it: in the next pass
    }

    /// Where a file is asked for.
    void save(const Photons& photons, const RunContext& context) {
        if (c_.settings.save_map.empty()) return;
        if (context.crew == nullptr || context.crew->rank() == 0)
            save_photons(c_.settings.save_map, photon_file_key(c_.scene, c_.settings, c_.reach), photons);
        saved_ = true;
    }

    /// Samples pixels, round by round of a pass. Returns whether the last round came to its end.
    bool sample_rounds(const PassGather& gather, std::int64_t pass, const RunContext& context) {
        const SamplingStage stage(c_.scene, c_.settings.spp, "gather", context);
        while (next_ && work_.pass_of(*next_) == pass) {
            if (!sample_round(c_.scene, *work_.unit().film, *next_, static_cast<std::uint64_t>(c_.settings.seed),
                              StreamPurpose::gather, *next_ == 0 ? context.first_round() : context, luminance_,
                              [&](const Vec2& image, SampleSource& source) { return gather.sample(image, source); })) {
                next_.reset();
                return false;
            }
            work_.end_unit(stats_);
            next_ = work_.take(context);
        }
        return true;
    }

    const SamplerContext& c_;
    const RenderPlan& plan_;
    PhotonSampler& sampler_;
    Work& work_;
    double for_gather_;
    RenderStats& stats_;
    RunningStats luminance_;
    bool saved_ = false;
    std::optional<std::int64_t> next_; // unit
};

} // namespace

void plan_photons(const Scene& scene, const Settings& settings, const UserPaths& paths, const RunContext& context,
                  Findings& findings) {
    if (!findings.patches) findings.patches.emplace(scene);
    if (!findings.plan) findings.plan = plan_render({scene, settings, *findings.patches, paths}, context);
}

RenderResult render_photons(const Scene& scene, const Settings& settings, const UserPaths& paths,
                            const RunContext& context, const Share& share, Findings& findings) {
    RenderResult result;
    RenderStats& stats = result.stats;
    if (!findings.patches) findings.patches.emplace(scene);
    SamplerContext c{scene, settings, *findings.patches, paths};
    // A crew has to come to one plan: who is stopped in the middle of a trial would make another.
    RunContext deciding = context;
    if (share.crew != nullptr) deciding.stop = nullptr;
    // Standard photon mapping plans otherwise.
    Findings own;
    Findings& planned = settings.method == "pm" ? own : findings;
    if (!planned.plan) {
        const StageClock clock(stats, "plan");
        planned.plan = plan_render(c, deciding);
    }
    const RenderPlan& plan = *planned.plan;
    if (!plan.photons) stats.remarks.push_back("no photon maps: " + plan.items.front().why);
    c.reach = plan.reach ? &*plan.reach : nullptr;
    c.caustics = plan.caustics || c.reach != nullptr;
    if (plan.photons && settings.reach != "off")
        stats.values["light beyond gather rays is stored"] = plan.reach ? 1 : 0;
    const std::optional<ImageWeight> weight = weigh_pixels(c, plan, stats, deciding);
    c.weight = weight ? &*weight : nullptr;
    const auto sampler = make_sampler(c, plan, stats, deciding);
    Work work(settings, scene.camera().window(), Exposure::Parts::film, share, settings.spp, Work::PassStart::costly);
    Passes passes(c, plan, *sampler, work, share.for_gather, stats);
    if (work.crew() == nullptr)
        passes.run(context);
    else
        passes.run_together(context);
    if (!settings.save_map.empty() && !passes.has_saved_photons())
        stats.warnings.emplace_back("no photons were saved: those of the first pass were not made here");
    sampler->finish(stats);
    warn_of_photons(stats, work.passes());
    report_eye_samples(passes.luminance(), scene, stats);
    result.picture = work.finish(stats);
    return result;
}

} // namespace keyhole
