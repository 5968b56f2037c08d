// The methods that render from photon maps: pass by pass a sampler, the maps, the gather.
#include "core/error.h"
#include "core/shared_work.h"
#include "methods/method.h"
#include "methods/photons/memory_plan.h"
#include "methods/photons/pass_gather.h"
#include "methods/photons/photon_file.h"
#include "methods/photons/photon_report.h"
#include "methods/photons/photon_sampler.h"
#include "methods/photons/plan.h"
#include "methods/sample_report.h"
#include "session/passes.h"
#include "session/pixel_sampling.h"
#include "session/stage_clock.h"
#include "session/work.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

namespace keyhole {
namespace {

constexpr Stage kPlanning{"plan"}, kPixelBrightness{"brightness of pixels"}, kReport{"error of photons and pixels"};

/// Where no light is that photon maps would hold.
class NoPhotons final : public PhotonSampler {
  public:
    Photons sample(std::uint64_t /*seed*/, RenderStats& /*stats*/, const RunContext& /*context*/) override {
        return {};
    }
};

/// The photons of settings.load_map. sample() throws InputError if the file isn't for this scene.
class FileSampler final : public PhotonSampler {
  public:
    /// @throws InputError if more than one pass is asked for.
    explicit FileSampler(const SamplerContext& context) : c_(context) {
        if (context.settings.passes != 1)
            throw InputError(
                fmt::format("found passes={} and target_error={} with --load-map, expected one pass and no "
                            "target: the photons of a file are the same in every pass",
                            context.settings.passes, context.settings.target_error));
    }

    Photons sample(std::uint64_t /*seed*/, RenderStats& stats, const RunContext& /*context*/) override {
        Photons photons = load_photons(c_.settings.load_map, photon_file_key(c_.scene, c_.settings, c_.coverage));
        const std::size_t found = photons.global.size() + photons.caustic.size();
        if (c_.settings.photons > 0)
            stats.remarks.push_back(fmt::format("photons={} has no effect with --load-map: the {} of the file are used",
                                                c_.settings.photons, found));
        if (const std::size_t held = photons_held(); found > held)
            stats.warnings.push_back(fmt::format("{}: {} photons, where photon_memory holds {}: the map takes more "
                                                 "memory than it may",
                                                 c_.settings.load_map, found, held));
        return photons;
    }

  private:
    /// By the memory alone.
    std::size_t photons_held() const {
        Settings s = c_.settings;
        s.photons = 0;
        return plan_memory(s, ImportanceUse::none, 2).photons;
    }

    SamplerContext c_;
};

std::unique_ptr<PhotonSampler> make_sampler(const SamplerContext& c, const RenderPlan& plan) {
    if (!c.settings.load_map.empty()) return std::make_unique<FileSampler>(c);
    if (!plan.photons) return std::make_unique<NoPhotons>();
    return c.settings.method->make_sampler(c);
}

/// The weights of pixels, where the user asked for them and something can follow them.
std::optional<ImageWeight> weigh_pixels(const SamplerContext& c, const RenderPlan& plan, RenderStats& stats,
                                        const RunContext& context) {
    const Settings& s = c.settings;
    if (!s.equalise || !plan.photons || s.method->stores_everywhere() || !s.load_map.empty()) return std::nullopt;
    const StageClock clock(stats, kPixelBrightness);
    return measure_image_weight(c.scene, static_cast<int>(s.max_depth), s.seed, context);
}

/// Renders one pass after the other.
class Passes {
  public:
    Passes(const SamplerContext& c, const RenderPlan& plan, PhotonSampler& sampler, Work& work, const RenderTask& task,
           RenderStats& stats)
        : c_(c), plan_(plan), sampler_(sampler), work_(work), for_gather_(task.share.for_gather),
          checks_photons_(task.share.checks_photons), observer_(task.observer), stats_(stats),
          pixels_(c.scene, c.settings, task.share, StreamPurpose::gather) {}

    /// All passes that there are units of.
    /// @throws Interrupted if there is nothing to show, and no photons were kept.
    void run(const RunContext& context) {
        next_ = work_.take(context);
        try {
            while (next_ && run_pass(work_.pass_of(*next_), context)) {
            }
        } catch (const Interrupted&) {
            if (work_.is_first() && !stats_.has_saved_map) throw; // what the pass before left is a picture
        }
    }
    /// The same by a process group: each helps with every pass, whether or not it gets to sample pixels from it.
    void run_together(const RunContext& context) {
        RunContext together = context;
        together.communicator = work_.communicator();
        try {
            next_ = work_.take(context);
            for (auto pass = work_.pass_from(0); pass; pass = work_.pass_from(*pass + 1))
                if (!run_pass(*pass, together)) break;
        } catch (const ProcessLost&) { // whoever collects what is done says so
        }
    }
    const PixelSampling& pixels() const { return pixels_; }
    /// Whether there were photons to tell of, be it none at all.
    bool has_sampled() const { return has_sampled_; }

  private:
    /// Returns whether to go on.
    bool run_pass(std::int64_t pass, const RunContext& context) {
        const std::uint64_t seed = seed_of_pass(c_.settings, pass);
        RunContext early = context;
        early.reserve += for_gather_;
        Photons photons = sampler_.sample(seed, stats_, early);
        if (pass == 0) save(photons, early);
        // The photons of a pass that was cut short are good for a first picture, not for one that is there.
        if (early.stopped() && (context.communicator != nullptr || !work_.is_first())) return false;
        report_photons(photons, stats_);
        has_sampled_ = true;
        if (observer_ != nullptr) observer_->sampled(photons);
        const PassGather gather(c_, plan_, pass, seed, std::move(photons), stats_, context);
        if (observer_ != nullptr) observer_->ready(gather);
        if (context.communicator != nullptr && context.stopped()) return false;
        const bool for_show = work_.keeps_units() && context.stopped(); // what was made for it may lack something
        const bool whole = sample_rounds(gather, pass, for_show, context.alone());
        {
            const StageClock clock(stats_, kReport);
            gather.report(stats_, checks_photons_);
        }
        return whole ||
               context.communicator != nullptr; // a process group ends where all can agree on it: in the next pass
    }

    /// Where a file is asked for.
    void save(const Photons& photons, const RunContext& context) {
        if (c_.settings.save_map.empty()) return;
        stats_.has_saved_map = true;
        if (context.communicator != nullptr && context.communicator->rank() > 0) return;
        if (context.stopped()) {
            std::error_code error;
            const bool there = std::filesystem::exists(c_.settings.save_map, error);
            stats_.cut_map =
                fmt::format("{}: the render was stopped before all photons of the pass were there: {}",
                            c_.settings.save_map, there ? "the older file stays" : "the file has a part of them");
            if (there) return;
        }
        try {
            save_photons(c_.settings.save_map, photon_file_key(c_.scene, c_.settings, c_.coverage), photons);
        } catch (const InputError& e) { // the picture must not be lost with them
            stats_.unsaved = e.what();
        }
    }

    /// Samples pixels, round by round of a pass; `for_show`: one that is no unit. Returns whether the last round came
    /// to its end.
    bool sample_rounds(const PassGather& gather, std::int64_t pass, bool for_show, const RunContext& context) {
        const StageClock clock(stats_, stages::gather);
        const SamplingStage stage(c_.scene, c_.settings.spp, "gather", context);
        while (next_ && work_.pass_of(*next_) == pass) {
            const bool whole =
                pixels_.take_round(*work_.unit().film, *next_, context, [&](const Vec2& image, SampleSource& source) {
                    return gather.sample(image, source);
                });
            if (!whole || for_show) {
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
    double for_gather_; // as WorkPartition's
    bool checks_photons_;
    PassObserver* observer_;
    RenderStats& stats_;
    PixelSampling pixels_;
    std::optional<std::int64_t> next_; // unit
    bool has_sampled_ = false;
};

} // namespace

void plan_photons(const Scene& scene, const Settings& settings, const UserPaths& paths, const RunContext& context,
                  Findings& findings) {
    if (!findings.patches) findings.patches.emplace(scene);
    if (!findings.plan) findings.plan = plan_render({scene, settings, *findings.patches, paths}, context);
}

RenderResult render_photons(const RenderTask& task) {
    const auto& [scene, settings, paths, context, share, findings, observer] = task;
    RenderResult result;
    RenderStats& stats = result.stats;
    if (!findings.patches) findings.patches.emplace(scene);
    SamplerContext c{scene, settings, *findings.patches, paths};
    // A group of processes has to come to one plan: who is stopped in the middle of a trial would make another.
    RunContext deciding = context;
    if (share.communicator != nullptr) deciding.stop = nullptr;
    // Standard photon mapping plans otherwise.
    Findings own;
    Findings& planned = settings.method->stores_everywhere() ? own : findings;
    if (!planned.plan) {
        const StageClock clock(stats, kPlanning);
        planned.plan = plan_render(c, deciding);
    }
    const RenderPlan& plan = *planned.plan;
    if (!plan.photons) stats.remarks.push_back("no photon maps: " + plan.items.front().why);
    c.coverage = plan.coverage ? &*plan.coverage : nullptr;
    c.caustics = plan.caustics || c.coverage != nullptr;
    if (plan.photons && settings.gather_coverage)
        stats.values["light beyond gather rays is stored"] = plan.coverage ? 1 : 0;
    const std::optional<ImageWeight> weight = weigh_pixels(c, plan, stats, deciding);
    c.weight = weight ? &*weight : nullptr;
    c.shares = &findings.shares;
    c.observer = observer;
    Work work(settings, scene.camera().window(), AccumulationBuffer::Parts::film, share, settings.spp,
              Work::PassStart::costly);
    c.keeps_units = work.keeps_units();
    const auto sampler = make_sampler(c, plan);
    Passes passes(c, plan, *sampler, work, task, stats);
    if (work.communicator() == nullptr)
        passes.run(context);
    else
        passes.run_together(context);
    if (!settings.save_map.empty() && !stats.has_saved_map)
        stats.warnings.emplace_back("no photons were saved: those of the first pass were not made here");
    sampler->finish(stats);
    // Where none were planned a remark says why.
    if (passes.has_sampled() && plan.photons) warn_of_photons(stats, work.passes(), settings.max_depth);
    passes.pixels().report(stats);
    report_eye_samples(passes.pixels().luminances(), scene, stats);
    report_black(passes.pixels().luminances(), scene, stats, true);
    result.picture = work.finish(stats);
    return result;
}

constinit const Method methods::automatic{.name = "auto",
                                          .help = "the one that leaves the least error, by trials",
                                          .keeps_photons = true,
                                          .follows_user_paths = true,
                                          .asks_for_direct_light = true,
                                          .importance = ImportanceUse::guide,
                                          .render = render_photons};

} // namespace keyhole
