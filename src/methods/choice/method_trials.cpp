#include "methods/choice/method_trials.h"

#include "core/shared_work.h"
#include "methods/choice/affordable.h"
#include "methods/choice/first_look.h"
#include "methods/choice/rank_methods.h"
#include "methods/choice/stage_balance.h"
#include "methods/method.h"
#include "session/passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace keyhole {
namespace {

/// Of the whole time, at most; and so many seconds with a smaller share of longer times.
constexpr double kMost = 0.08, kSeconds = 0.4, kShare = 0.03;
/// After that share of it, by photons' fault, no other method is tried.
constexpr double kMostWithPhotons = 0.18;
/// In less time than that a trial shows nothing; of the whole time, what is spent to have it.
constexpr double kLeastSeconds = 0.3, kMostForLeast = 0.15;
/// Of the whole time, what the survey that methods with photons start with may take.
constexpr double kPlan = 0.12;
/// A trial that takes so many times as long as it should is given up.
constexpr double kPatience = 3;
/// Photons need some time however little they are to do: that share of all of it, up to so many seconds. To do without
/// them may cost a hundred times the error.
constexpr double kPatienceForPhotons = 0.08, kMostPatience = 0.8;
/// Two renders that take so many times a trial's time together are enough: what photons blur isn't told then.
constexpr double kPatienceForNarrow = 4;
/// What traces importance costs is told by so many walks.
constexpr std::int64_t kImportons = 2000;
/// Rays of records in a trial: their noise is told by few, and there are many records even in a small window.
constexpr std::int64_t kCacheRays = 64;
/// Number of the first render of a trial, for its seed; those that count have others.
constexpr std::int64_t kTrialSeed = std::int64_t{1} << 20;
/// Share of the light from which on it matters that photons blur caustics.
constexpr double kCausticLight = 0.1;
/// Squared error from which on dots are told: a tenth of the light.
constexpr double kDotsToTell = 0.01;
/// Share of the pixels with light below which what trials say is a guess.
constexpr double kLittleLight = 0.1;
/// Of trials by work: seconds that a window of their size is for, and samples of its pixels.
constexpr double kTrialOfWork = 0.7;
constexpr std::int64_t kSamplesOfTrial = 4;
/// A single trial has the window of as many seconds as all would take together.
constexpr double kTrialsOfATrial = 8;

/// Pixels of the window of trials that take so many seconds together: enough to tell errors by, few enough for several
/// samples of each.
double trial_pixels(double seconds) { return std::clamp(1800 * seconds, 600.0, 4800.0); }

ImageWindow trial_window(ImageWindow window, double seconds) {
    const double scale = std::max(1.0, std::sqrt(window.size() / trial_pixels(seconds)));
    window.width = std::max(1, static_cast<int>(window.width / scale));
    window.height = std::max(1, static_cast<int>(window.height / scale));
    return window;
}

/// Sets a window for as long as it lives.
class WindowScope {
  public:
    WindowScope(Scene& scene, const Settings& settings, const ImageWindow& window)
        : scene_(scene), before_(scene.camera().window()) {
        scene_.set_window(window);
        set_window_margin(scene_, settings);
    }
    ~WindowScope() { scene_.set_window(before_); }
    WindowScope(const WindowScope&) = delete;
    WindowScope& operator=(const WindowScope&) = delete;

  private:
    Scene& scene_;
    ImageWindow before_;
};

/// Settings of a render of the scene's window with so much effort.
Settings trial_settings(const TrialContext& c, const Method& method, double effort) {
    Settings s = c.settings;
    s.method = &method;
    // What is given may be much: it is left for the render.
    s = with_effort(s, effort, static_cast<std::int64_t>(c.scene.camera().window().size()), {});
    s.importons = std::min(s.importons, kImportons);
    if (c.context.stop != nullptr) s.cache_rays = std::min(s.cache_rays, kCacheRays);
    s.save_map.clear();
    s.chain_groups = 1;
    if (method.samples_pixels) s.spp = 1 << 24; // as many as the cap leaves time for, unless somebody says how many
    return s;
}

struct TrialRender {
    Image luminance, direct;
    double caustic; ///< share of the light
    TrialCost of;
};

/// The share of a picture's light that is in a layer.
double share_of(const Image& layer, const Image& picture) {
    const auto sum = [](const Image& i) { return std::accumulate(i.data.begin(), i.data.end(), 0.0); };
    const double all = sum(picture);
    return all > 0 ? sum(layer) / all : 0;
}

/// A render of the scene's window; none if it leaves holes. @throws Interrupted
std::optional<TrialRender> render_trial(const TrialContext& c, Settings settings, double effort,
                                        const RunContext& context) {
    const double start = context.seconds_left();
    const bool in_time = std::isfinite(start);
    const double pixels = c.scene.camera().window().size();
    WorkPartition share;
    share.checks_photons = false;
    const RenderResult r = render_by_method({c.scene, settings, c.user_paths, context, share, c.findings});
    if (!has_picture(r) || empty_pixels(r) > 0) return std::nullopt;
    settings.spp = std::max<std::int64_t>(1, static_cast<std::int64_t>(r.stats.samples));
    // Light paths that are told where to go bring many times the photons of a trial's: up to what is allowed, then.
    settings.photons = std::max<std::int64_t>(
        1, static_cast<std::int64_t>(r.stats.photons_global + r.stats.photons_caustic) / settings.passes);
    TrialCost of = in_time ? cost_of_render(c.scene, settings, effort, pixels, r.stats, start - context.seconds_left())
                           : TrialCost{.cost = Experience::in_rays(settings, effort, pixels, r.stats),
                                       .taken = 0,
                                       .samples = r.stats.samples,
                                       .balance = {},
                                       .noise = std::nullopt};
    if (!in_time) of.taken = of.cost.total();
    Image all = luminance_of(r.picture);
    const double caustic = share_of(luminance_of(r.picture, "caustic"), all);
    return TrialRender{std::move(all), luminance_of(r.picture, "direct"), caustic, std::move(of)};
}

/// The same under a cap; none if it was given up.
std::optional<TrialRender> render_trial(const TrialContext& c, const Settings& settings, double effort, double most) {
    RunContext limited = c.context;
    limited.progress = nullptr;
    limited.reserve = std::max(0.0, c.context.stop->seconds_left() - most);
    limited.whole_round = settings.method->keeps_photons; // what came before takes most of the time
    try {
        return render_trial(c, settings, effort, limited);
    } catch (const Interrupted&) {
        return std::nullopt;
    }
}

/// The share of the grain that only samples of pixels make less: that of direct light, and of all light on surfaces
/// that no record serves. Light of photons and records looks like grain as well where pixels are large.
double by_samples(const TrialContext& c, const TrialRender& first, const TrialRender& second) {
    const double direct = share_of_grain({first.direct, second.direct}, {first.luminance, second.luminance});
    const double glossy = c.findings.plan ? std::min(1.0, c.findings.plan->survey.glossy) : 1;
    return direct + (1 - direct) * glossy;
}

/// Finds out what methods with photons need to know; false if that takes longer than so many seconds.
bool plan(const TrialContext& c, double most) {
    Settings s = c.settings;
    s.importons = std::min(s.importons, kImportons);
    RunContext limited = c.context;
    limited.progress = nullptr;
    limited.reserve = std::max(0.0, c.context.stop->seconds_left() - most);
    try {
        plan_photons(c.scene, s, c.user_paths, limited, c.findings);
    } catch (const Interrupted&) {
        return false;
    }
    return true;
}

/// Pixels of the picture in the middles of those of a window that is smaller by `scale`.
void narrow_pixels(Settings& s, double scale) {
    s.filter = FilterShape::box;
    s.filter_radius = 0.5 / scale;
}

double effort_of(double seconds) { return std::min(seconds / kSecondsOfEffort, 0.1); }

/// The two renders of a method with settings `s`, and of path tracing those with narrow pixels, too; of others as well,
/// where light is caustic and these two took no more than `patience`. None if one is missing.
/// @param scale of the picture over the window.
/// @param patience seconds, or rays.
/// @param render makes one: render(settings, is_first).
template <class Render>
std::optional<TriedMethod> try_with(const TrialContext& c, Settings s, double scale, double patience,
                                    const Render& render) {
    s.seed = seed_of_render(c.settings, kTrialSeed);
    auto first = render(s, true);
    if (!first) return std::nullopt;
    if (s.method->samples_pixels) s.spp = first->of.cost.settings.spp; // both are to cost the same
    s.seed = seed_of_render(c.settings, kTrialSeed + 1);
    auto second = render(s, false);
    if (!second) return std::nullopt;
    const double samples = s.method->keeps_photons ? by_samples(c, *first, *second) : 1;
    TriedMethod tried{.method = s.method,
                      .pictures = {std::move(first->luminance), std::move(second->luminance)},
                      .narrow = {},
                      .by_samples = samples,
                      .of = std::move(second->of),
                      .error = {}};
    const bool caustics = first->caustic > kCausticLight && (s.method->samples_pixels || s.method->keeps_photons) &&
                          first->of.taken + tried.of.taken <= patience;
    if (s.method == &methods::path || caustics) {
        narrow_pixels(s, scale);
        auto third = render(s, false);
        s.seed = seed_of_render(c.settings, kTrialSeed);
        auto fourth = render(s, false);
        if (third && fourth) tried.narrow = {std::move(third->luminance), std::move(fourth->luminance)};
    }
    return tried;
}

/// A trial of one method in about so many seconds; none where it is too slow for that.
std::optional<TriedMethod> try_method(const TrialContext& c, const Method& method, const ImageWindow& small,
                                      double seconds) {
    const double scale = static_cast<double>(c.scene.camera().window().width) / small.width;
    const WindowScope window(c.scene, c.settings, small);
    const double half = seconds / 2, effort = effort_of(half);
    double most = kPatience * half;
    if (method.keeps_photons)
        most = std::max(most, std::min(kPatienceForPhotons * c.context.stop->seconds_left(), kMostPatience));
    const double patience = kPatienceForNarrow * seconds;
    return try_with(c, trial_settings(c, method, effort), scale, patience, [&](const Settings& s, bool is_first) {
        return render_trial(c, s, effort, is_first && method.samples_pixels ? half : most);
    });
}

/// In a time.
bool may_try(const TrialContext& c, const Method& method) {
    return method.trial.share > 0 && can_do(c.scene, c.settings, method);
}

/// Rays that light tracing by importance would take with the settings, or else the first of the methods.
double work_asked_for(const TrialContext& c, std::span<const TriedMethod> tried) {
    const double pixels = c.scene.camera().window().size();
    const auto ipm = std::ranges::find(tried, &methods::ipm, &TriedMethod::method);
    if (ipm == tried.end()) {
        return static_cast<double>(c.settings.spp) * tried.front().of.per_sample(pixels);
    }
    Settings s = c.settings;
    s.method = &methods::ipm;
    return ipm->of.cost.predict(s, pixels);
}

/// The share of the pixels in which any trial found light.
double share_lit(std::span<const TriedMethod> tried) {
    std::vector<TrialPictures> pictures;
    for (const TriedMethod& t : tried) pictures.push_back(t.pictures);
    return keyhole::share_lit(pictures);
}

RankLimits limits_in_time(const TrialContext& c) {
    return {.passes = fills_passes(c.settings) ? static_cast<double>(kPassesInTime) : 1};
}

/// Whether those that were tried, the best first, promise so little error that another trial isn't worth its time.
bool is_needless(const Method& method, std::span<const TriedMethod> tried) {
    return share_lit(tried) >= kLittleLight && tried.front().predicted < method.trial.needless_below;
}

/// Whether each pixel gets a sample in the time that is left. Paths are traced where none has time for that.
bool has_time_for_a_sample(const TriedMethod& t, const TrialContext& c) {
    return !t.method->samples_pixels || t.method == &methods::path ||
           t.of.per_sample(c.scene.camera().window().size()) < c.context.stop->seconds_left();
}

} // namespace

Settings TrialCost::settings_for(const Settings& s, const std::set<std::string>& given, double pixels, double seconds,
                                 double& effort) const {
    effort = affordable_effort(cost, s, given, balance, pixels, seconds);
    const Settings even = with_effort(s, effort, static_cast<std::int64_t>(pixels), given, balance);
    return noise ? split_stage_three(even, cost, *noise, pixels, given) : even;
}

TrialCost cost_of_render(const Scene& scene, const Settings& settings, double effort, double pixels,
                         const RenderStats& stats, double seconds) {
    return {.cost = Experience(settings, effort, pixels, stats, seconds),
            .taken = seconds,
            .samples = stats.samples,
            .balance = rebalance({}, stats, scene.traits().delta),
            .noise = stats.photon_quality.noise};
}

std::optional<TrialCost> try_cost(const TrialContext& c, const Method& method, double seconds, double most) {
    const WindowScope window(c.scene, c.settings, trial_window(c.scene.camera().window(), kTrialsOfATrial * seconds));
    Settings s = trial_settings(c, method, effort_of(seconds));
    s.seed = seed_of_render(c.settings, kTrialSeed);
    auto trial = render_trial(c, s, effort_of(seconds), most);
    return trial ? std::optional(std::move(trial->of)) : std::nullopt;
}

std::vector<TriedMethod> try_methods(const TrialContext& c, double most) {
    const double start = c.context.stop->seconds_left();
    const double least = std::min(kLeastSeconds, kMostForLeast * start);
    const double budget = std::min({std::max(kMost * start, least), kSeconds + kShare * start, most});
    double beyond = 0; // what photons took more than their part, which the others don't go without
    const ImageWindow small = trial_window(c.scene.camera().window(), budget);
    std::vector<TriedMethod> tried;
    for (const Method* method : all_methods()) {
        const double part = method->trial.share * budget;
        if (!may_try(c, *method)) continue;
        const double before = start - c.context.stop->seconds_left();
        if (c.context.stopped() || before - beyond + part > budget || before > kMostWithPhotons * start) break;
        if (method->trial.needless_below > 0 && !tried.empty())
            rank_methods(tried, c, c.context.stop->seconds_left(), limits_in_time(c));
        if (is_needless(*method, tried)) continue;
        if (method->keeps_photons && !plan(c, std::min(kPlan * start, most))) continue;
        if (auto t = try_method(c, *method, small, part); t && has_time_for_a_sample(*t, c))
            tried.push_back(std::move(*t));
        const double taken = start - c.context.stop->seconds_left() - before;
        if (method->keeps_photons) beyond += std::max(0.0, taken - part);
    }
    rank_methods(tried, c, c.context.stop->seconds_left(), limits_in_time(c));
    return tried;
}

std::vector<TriedMethod> try_methods_by_work(const TrialContext& c) {
    std::vector<TriedMethod> tried;
    {
        const ImageWindow small = trial_window(c.scene.camera().window(), kTrialOfWork);
        const double scale = static_cast<double>(c.scene.camera().window().width) / small.width;
        const WindowScope window(c.scene, c.settings, small);
        RunContext context = c.context;
        context.progress = nullptr;
        const double asked = static_cast<double>(std::max(c.settings.light_paths, c.settings.mutations)) / 500e3;
        const double effort = std::clamp(0.02 * asked, 0.001, 0.01);
        for (const Method* method : all_methods()) {
            if (!method->trial.by_work || !can_do(c.scene, c.settings, *method)) continue;
            Settings s = trial_settings(c, *method, effort);
            if (method->samples_pixels) s.spp = kSamplesOfTrial;
            const auto render = [&](const Settings& of, bool) { return render_trial(c, of, effort, context); };
            if (auto t = try_with(c, s, scale, std::numeric_limits<double>::infinity(), render))
                tried.push_back(std::move(*t));
        }
    }
    RankLimits limits;
    if (c.settings.keep_spp) limits.samples = static_cast<double>(c.settings.spp);
    if (!tried.empty()) rank_methods(tried, c, work_asked_for(c, tried), limits);
    return tried;
}

Settings settings_of_same_work(const TrialContext& c, std::span<const TriedMethod> tried) {
    const TriedMethod& best = tried.front();
    Settings s = c.settings;
    s.method = best.method;
    const double pixels = c.scene.camera().window().size(), work = work_asked_for(c, tried);
    if (best.method->samples_pixels) {
        if (!s.keep_spp) s.spp = std::max(s.spp, static_cast<std::int64_t>(work / best.of.per_sample(pixels)));
    } else if (!best.method->keeps_photons) {
        const double effort = affordable_effort(best.of.cost, s, {}, {}, pixels, work);
        const Settings same = with_effort(s, effort, static_cast<std::int64_t>(pixels), {});
        s.mutations = std::max(s.mutations, same.mutations);
    }
    return s;
}

std::string describe_choice(const TrialContext& c, std::span<const TriedMethod> tried) {
    const double lit = share_lit(tried);
    if (!(lit > 0)) return fmt::format("method {} chosen, for no trial found any light", tried.front().method->name);
    std::string text = fmt::format(
        "method {} chosen by trial{}: squared relative errors for this time or work would be about",
        tried.front().method->name,
        lit < kLittleLight ? fmt::format(", a guess, for trials found light in {:.2g} % of the pixels", 100 * lit)
                           : "");
    for (const TriedMethod& t : tried)
        text += fmt::format("{} {} {:.2g}", &t == tried.data() ? "" : ",", t.method->name, t.predicted);
    std::string needless, too_slow;
    for (const Method* method : all_methods()) {
        if (!std::isfinite(c.context.seconds_left()) || !may_try(c, *method) ||
            std::ranges::find(tried, method, &TriedMethod::method) != tried.end())
            continue;
        (is_needless(*method, tried) ? needless : too_slow) += fmt::format(" {},", method->name);
    }
    const auto add = [&](const char* words, std::string& names) {
        if (names.empty()) return;
        names.pop_back();
        text += words + names;
    };
    add("; there was too little time to try", too_slow);
    add(too_slow.empty() ? "; the error is too small to try" : ", and the error is too small to try", needless);
    return text;
}

void warn_of_dots(const Method& method, const TrialError& error, RenderStats& stats) {
    if (!(error.dots > kDotsToTell)) return;
    stats.warn(Doubt::samples,
               fmt::format("its trial shows that {} brings in a few bright samples what other methods find everywhere: "
                           "expect dots there, and darkness between them. Try another method, or more time",
                           method.name));
}

} // namespace keyhole
