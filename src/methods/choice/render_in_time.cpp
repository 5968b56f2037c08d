#include "methods/choice/render_in_time.h"

#include "core/error.h"
#include "core/shared_work.h"
#include "methods/choice/affordable.h"
#include "methods/choice/differences.h"
#include "methods/choice/effort.h"
#include "methods/choice/filtered_grain.h"
#include "methods/choice/first_look.h"
#include "methods/choice/mean_render.h"
#include "methods/choice/method_trials.h"
#include "methods/choice/stage_balance.h"
#include "methods/method.h"
#include "methods/preparation.h"
#include "session/passes.h"
#include "session/stage_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace keyhole {
namespace {

/// Two methods are close if the one promises less than so many times the error of the other.
constexpr double kClose = 1.5;
/// Of the time, each of the two renders of either method that show how large their errors are.
constexpr double kPart = 1.0 / 24;
/// Samples of a pixel that the first of them should have.
constexpr double kSamplesOfPart = 1.5;
/// What counts less than this share of the better method's seconds would only cost it its statistics.
constexpr double kNoWeight = 0.2;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Of the time for a render with photons or chains that its predicted cost is to fill. What is left then goes into more
/// samples of pixels, or more mutations.
constexpr double kUse = 0.92, kMoreMutations = 1.5;
/// Times the time of a render that settings given by number take, from which on that is told.
constexpr double kTooMuch = 0.8;
/// Less than this share of all time is not worth a render with photons.
constexpr double kLeast = 0.05;
/// The trial of a method by name: of the time, what it is to take and what it may take.
constexpr double kTrialShare = 0.02, kLongestTrial = 0.6, kTrialSeconds = 0.5;
/// The same of one with photons: the least that it can do may take most of the time, and makes a picture.
constexpr double kLongestWithPhotons = 0.25;
/// Of the first render where a trial took too long, whose cost tells what others take.
constexpr double kEffortWithoutTrial = 1e-4;

/// Renders a scene for as long as there is time.
class RenderInTime {
  public:
    RenderInTime(Scene& scene, const Settings& settings, const std::set<std::string>& given, const RunContext& context,
                 const UserPathFile& user_paths, const WorkPartition& share)
        : scene_(scene), settings_(settings), given_(given), context_(context), given_paths_(user_paths), share_(share),
          start_(left()), method_(settings.method) {
        require_can_show(scene, settings);
        set_window_margin(scene, settings);
        if (!given.contains("brightness_error")) settings_.brightness_error = 0; // stage one gets its part, no more
        pixels_ = scene.camera().window().size();
    }

    RenderResult run() {
        try {
            choose(kLongestWithPhotons);
            if (is_close()) spend_in_parts();
            while (mean_.empty() || (left() > kLeast * start_ && !used_up_)) {
                if (context_.stop->requested() || (context_.stopped() && !method_->samples_pixels)) break;
                render_rest();
                if (context_.stopped()) break;
            }
        } catch (const Interrupted&) { // too slow for the time, or somebody doesn't want to wait
        }
        return mean_.empty() ? without_picture() : finish();
    }

    PassesInTime choose_passes() {
        try {
            choose(kLongestTrial);     // passes follow from what it tells
        } catch (const Interrupted&) { // too slow for a trial
            if (method_ == &methods::automatic) use(methods::path);
        }
        PassesInTime passes{settings_of_passes(left()), {}, std::move(trials_)};
        if (cost_ && !method_->samples_pixels) {
            Settings one = passes.settings;
            one.passes = 1;
            passes.seconds = cost_->cost.predict(one, pixels_);
        }
        passes.stats.remarks = std::move(remarks_);
        passes.stats.remarks.push_back(
            fmt::format("set by the time{}:{}",
                        passes.seconds ? fmt::format(", for passes of about {:.2g} s", *passes.seconds) : "",
                        differences(settings_, passes.settings)));
        return passes;
    }

  private:
    double left() const { return context_.stop->seconds_left(); }
    TrialContext trial_context() {
        return {scene_, settings_, given_, context_, before_->paths(), before_->findings()};
    }
    /// Whether two methods are so close that a longer look is worth its time. Several small photon maps are worse than
    /// a large one, and what they show of it is little.
    bool is_close() const {
        return !fills_passes(settings_) && tried_.size() > 1 && tried_[1].predicted < kClose * tried_[0].predicted &&
               fits_part(tried_[0]) && fits_part(tried_[1]);
    }
    /// Whether a part of the time shows anything of the method: of one that samples pixels, a sample of each at least.
    bool fits_part(const TriedMethod& t) const {
        if (t.method->keeps_photons) return false;
        return !t.method->samples_pixels || kSamplesOfPart * t.of.per_sample(pixels_) < kPart * left();
    }

    /// The method, and what it costs; of the time, what the trial of one with photons may take.
    void choose(double longest_with_photons) {
        before_.emplace(scene_, settings_, given_paths_, context_);
        if (settings_.method != &methods::automatic) {
            use(*settings_.method);
            if (method_->samples_pixels && !fills_passes(settings_)) return;
            const StageClock clock(trials_, stages::trials);
            const double seconds = std::min(kTrialShare * start_, kTrialSeconds);
            const double longest = (method_->keeps_photons ? longest_with_photons : kLongestTrial) * start_;
            cost_ = try_cost(trial_context(), *method_, seconds, method_->samples_pixels ? seconds : longest);
            forget_rough_findings();
            if (!cost_ && !method_->samples_pixels && !method_->keeps_photons) throw Interrupted();
            return;
        }
        const StageClock clock(trials_, stages::trials);
        tried_ = try_methods(trial_context());
        forget_rough_findings();
        if (tried_.empty()) return use(methods::path);
        remarks_.push_back(describe_choice(trial_context(), tried_));
        take_over(tried_.front());
        at_choice_ = left();
    }
    /// How far gather rays come is found out anew, with more rays than trials spend on it, where it matters.
    void forget_rough_findings() { before_->findings().forget_coverage(); }
    void use(const Method& method) { method_ = &method; }
    void take_over(const TriedMethod& t) {
        use(*t.method);
        cost_ = t.of;
    }

    /// A part of the time by each of the two methods that promise most; the rest is for the one whose error turns out
    /// smaller. What the other has made counts by its error.
    void spend_in_parts() {
        const double part = kPart * left();
        std::array<Parts, 2> made;
        for (std::size_t k = 0; k < made.size(); ++k) {
            take_over(tried_[k]);
            made[k] = render_parts(part, tried_[k].predicted);
            if (cost_) tried_[k].of = *cost_; // these have shown more
            if (made[k].error < kNever)
                remarks_.push_back(fmt::format("the error of {} turns out to be {:.2g} where {:.2g} was predicted",
                                               method_->name, made[k].error, tried_[k].predicted));
            if (k == 0 && kClose * made[0].error < tried_[1].predicted) break; // not so close after all
        }
        // What is too slow for a part may be the better one for all: its trial has to do.
        const auto error = [&](std::size_t k) { return made[k].error < kNever ? made[k].error : tried_[k].predicted; };
        const std::size_t better = error(1) < error(0) ? 1 : 0;
        take_over(tried_[better]);
        for (std::size_t k = 0; k < made.size(); ++k) {
            const double weight = k == better ? 1 : error(better) / error(k);
            if (!made[k].mean.empty() && weight > kNoWeight) mean_.add(made[k].mean.take(), weight * made[k].seconds);
        }
        remarks_.push_back("the rest of the time went to " + std::string(method_->name));
    }

    /// Two renders of the method, of so many seconds each.
    struct Parts {
        MeanRender mean;
        double seconds = 0;    ///< that they took
        double error = kNever; ///< that all of the time would leave, by what they differ in
    };
    Parts render_parts(double seconds, double predicted) {
        Parts parts;
        std::vector<Image> pictures;
        try {
            while (pictures.size() < 2 && !context_.stopped()) {
                auto part = render_part(seconds, false);
                if (!part) break;
                pictures.push_back(luminance_of(part->result.picture));
                parts.seconds += part->seconds;
                parts.mean.add(std::move(part->result), part->seconds);
            }
        } catch (const Interrupted&) { // too slow
        }
        if (pictures.size() < 2) return parts;
        const TrialPictures halves{std::move(pictures[0]), std::move(pictures[1]), method_->samples_pixels};
        const TrialError e = trial_errors(std::span(&halves, 1)).front();
        const double shown = (grain_that_counts(settings_, *method_) * e.grain + e.blotches) * seconds / at_choice_;
        // Two renders by chains don't show what both lack: trials had others' pictures to hold them against.
        parts.error = method_->samples_pixels ? shown : std::max(shown, predicted);
        return parts;
    }

    /// Settings that use so many seconds, or more where the last stage goes on as long as there is time.
    Settings settings_for(double seconds, bool open_ended) {
        if (fills_passes(settings_)) return settings_of_passes(seconds);
        Settings s = settings_;
        s.method = method_;
        if (!given_.contains("adaptive")) s.adaptive = true;
        if (method_->samples_pixels) {
            if (!given_.contains("spp")) s.spp = 1 << 24;
            return s;
        }
        if (!cost_) return with_effort(s, effort_ = kEffortWithoutTrial, static_cast<std::int64_t>(pixels_), given_);
        s = cost_->settings_for(s, given_, pixels_, kUse * seconds, effort_);
        gives_too_much_ = cost_of_given(cost_->cost, settings_, given_, pixels_) > kTooMuch * seconds;
        planned_spp_ = s.spp;
        if (!method_->keeps_photons) {
            s.chain_groups = 1;
            if (!given_.contains("mutations"))
                s.mutations = static_cast<std::int64_t>(kMoreMutations * static_cast<double>(s.mutations));
        } else if (open_ended && s.passes == 1 && !given_.contains("spp")) {
            s.spp = 1 << 24;
        }
        return s;
    }

    /// Settings of passes that are good for an error, too: none longer than its share of the time, nor than it would be
    /// without one.
    Settings settings_of_passes(double seconds) {
        Settings s = settings_;
        s.method = method_;
        const bool counted = given_.contains("passes") && s.passes > 0;
        s.passes = counted ? s.passes : 1;
        seconds *= kUse / (counted ? 1 : kPassesInTime);
        if (!method_->samples_pixels) {
            std::set<std::string> given = given_;
            given.insert("passes");
            if (cost_)
                s = cost_->settings_for(s, given, pixels_, std::min(seconds, cost_->cost.predict(s, pixels_)), effort_);
            else
                s = with_effort_at_most(s, seconds / kSecondsOfEffort, static_cast<std::int64_t>(pixels_), given);
        } else if (!given_.contains("spp")) {
            const double most = cost_ ? seconds / static_cast<double>(s.passes) / cost_->per_sample(pixels_) : 1;
            s.spp = std::max<std::int64_t>(1, std::min(s.spp, static_cast<std::int64_t>(most)));
        }
        planned_spp_ = s.spp;
        if (!counted) s.passes = 0;
        return s;
    }

    struct Part {
        RenderResult result;
        double seconds; ///< that it took
    };
    /// A render of so many seconds; the last one goes on to the end of the time. None where it leaves no picture.
    std::optional<Part> render_part(double seconds, bool last) {
        const double start = left();
        Settings chosen = settings_for(seconds, last);
        RunContext limited = context_;
        limited.whole_round = last && mean_.empty(); // a noisy picture is better than one with holes
        if (!last) limited.reserve = std::max(0.0, start - seconds);
        WorkPartition share = share_to_look_at();
        limited.by_time = last && chosen.passes == 1 && (cost_ || !method_->keeps_photons) &&
                          !given_.contains("cache_rays") && !given_.contains("spp");
        if (method_->keeps_photons && cost_) {
            if (cost_->noise)
                limited.rays_for_pixel = rays_for_pixel(*cost_->noise, cost_->cost, static_cast<double>(planned_spp_));
            Settings planned = chosen;
            planned.spp = std::min(chosen.spp, planned_spp_);
            share.for_gather = std::min(1.2 * cost_->cost.predict(Stage::Work::gather, planned, pixels_), seconds / 2) /
                               static_cast<double>(std::max<std::int64_t>(1, chosen.passes));
            if (!last) limited.reserve = std::max(0.0, start - 1.5 * seconds); // ends by itself
        }
        chosen.seed = seed_of_render(settings_, renders_++);
        if (renders_ > 1) chosen.save_map.clear();
        RenderResult result = render_by_method({scene_, chosen, before_->paths(), limited, share, before_->findings()});
        used_up_ = last && method_->samples_pixels && given_.contains("spp");
        const bool holes = empty_pixels(result) > 0;
        if (!has_picture(result) || (holes && (!last || !mean_.empty()))) {
            mean_.leave_out(result.stats);
            return std::nullopt;
        }
        if (chosen.spp == 1 << 24)
            chosen.spp = std::max<std::int64_t>(1, static_cast<std::int64_t>(std::lround(result.stats.samples)));
        if (effort_ > 0) result.stats.effort = effort_;
        result.stats.remarks.push_back("set by the time:" + differences(settings_, chosen));
        result.settings = chosen;
        if (method_->keeps_photons && !cost_ && !fills_passes(settings_))
            cost_ = cost_of_render(scene_, chosen, effort_, pixels_, result.stats, start - left());
        else if (cost_ && (method_->keeps_photons || result.stats.complete))
            cost_->cost = Experience(chosen, effort_, pixels_, result.stats, start - left());
        used_up_ = used_up_ || fills_passes(settings_);
        return Part{std::move(result), start - left()};
    }

    /// The last one, or one of several if there is a limit to what a render can do.
    void render_rest() {
        if (auto part = render_part(left(), true)) mean_.add(std::move(part->result), part->seconds);
    }

    /// Paths are a noisy picture, not a wrong one; but a method that somebody named isn't replaced in silence.
    RenderResult without_picture() {
        if (context_.stop->requested() || (settings_.method == &methods::automatic && context_.stopped()))
            return look_first();
        if (settings_.method != &methods::automatic)
            throw InputError(fmt::format("too little time for {0}: what it does before its first picture takes longer "
                                         "here; expected more than {1}, or another method",
                                         method_->name,
                                         start_ > 0 ? fmt::format("{:.2g} s", start_) : "what reading the scene took"));
        remarks_.push_back("paths are traced: " + std::string(method_->name) + " was not done in its time");
        use(methods::path);
        cost_.reset();
        render_rest();
        return mean_.empty() ? look_first() : finish();
    }
    RenderResult look_first() {
        RenderResult result = first_look(scene_, settings_);
        result.stats.take_word_of_map(mean_.of_map());
        return result;
    }

    RenderResult finish() {
        RenderResult result = mean_.take();
        const bool by_number = fills_passes(settings_) || (method_->samples_pixels && given_.contains("spp"));
        result.stats.complete = !context_.stop->requested() && (result.stats.complete || !by_number);
        if (result.stats.passes == 0) result.stats.passes.reset();
        result.stats.remarks.insert(result.stats.remarks.begin(), remarks_.begin(), remarks_.end());
        result.settings.seed = settings_.seed;
        result.stats.stages.insert(result.stats.stages.begin(), trials_.stages.begin(), trials_.stages.end());
        if (gives_too_much_)
            result.stats.warn(Doubt::render,
                              fmt::format("the settings that were given by number take more than the {:.2g} s "
                                          "that there are: what has to do with less makes noise. Leave "
                                          "them out, or give it more time",
                                          start_));
        for (const TriedMethod& t : tried_)
            if (t.method == method_) warn_of_dots(*method_, t.error, result.stats);
        if (before_) before_->report(result.stats);
        return result;
    }

    /// Who looks sees the mean once there is one, not the begin of what comes after.
    WorkPartition share_to_look_at() const {
        WorkPartition share = share_;
        if (share.look && !mean_.empty()) share.look = [this](const Picture&) { share_.look(mean_.picture()); };
        return share;
    }

    Scene& scene_;
    Settings settings_;
    const std::set<std::string>& given_;
    const RunContext& context_;
    const UserPathFile& given_paths_;
    const WorkPartition& share_;
    const double start_; // of time, in the beginning [s]
    double pixels_ = 0;
    std::optional<Preparation> before_;
    const Method* method_;           // the one that was asked for, until one is chosen
    std::optional<TrialCost> cost_;  // of the method; none for those that sample pixels
    std::vector<TriedMethod> tried_; // the best first
    double at_choice_ = 0;           // time that was left then [s]
    double effort_ = 0;              // of the render under way
    std::int64_t planned_spp_ = 0;   // of it
    bool used_up_ = false;           // everything that was asked for by number is done before the time
    bool gives_too_much_ = false;    // what was asked for by number takes longer than the render's time
    std::int64_t renders_ = 0;       // begun
    std::vector<std::string> remarks_;
    RenderStats trials_; // their time
    MeanRender mean_;
};

} // namespace

RenderResult render_in_time(Scene& scene, const Settings& settings, const std::set<std::string>& given,
                            const RunContext& context, const UserPathFile& user_paths, const WorkPartition& share) {
    RenderResult result = RenderInTime{scene, settings, given, context, user_paths, share}.run();
    if (result.stats.cut_map) result.stats.warn(Doubt::photons, *result.stats.cut_map);
    if (!settings.save_map.empty() && !result.stats.has_saved_map && !method_named(result.stats.method).keeps_photons)
        result.stats.warnings.emplace_back("no photons were saved: there was too little time for them");
    return result;
}

PassesInTime passes_in_time(Scene& scene, const Settings& settings, const std::set<std::string>& given,
                            const RunContext& context, const UserPathFile& user_paths) {
    Settings open = settings; // as if nobody had said how many
    open.passes = 0;
    std::set<std::string> others = given;
    others.erase("passes");
    PassesInTime passes = RenderInTime{scene, open, others, context, user_paths, {}}.choose_passes();
    passes.settings.passes = settings.passes;
    return passes;
}

} // namespace keyhole
