#include "render/effort.h"

#include "core/error.h"
#include "render/memory_plan.h"
#include "render/methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace keyhole {
namespace {

constexpr double kPixels = 320 * 240;  // of the picture that effort is measured by
constexpr double kSecondsOfEffort = 5; // CPU time of a unit on it

/// Passes that bring `wanted` photons, as many of them as the memory holds at a time.
std::int64_t passes_for(std::int64_t wanted, Settings settings) {
    settings.photons = 0;
    const ImportanceUse use = settings.method == "pm"    ? ImportanceUse::none
                              : settings.method == "mps" ? ImportanceUse::beside
                                                         : ImportanceUse::guide;
    const auto held = static_cast<std::int64_t>(plan_memory(settings, use, 2).photons);
    return std::max<std::int64_t>(1, (wanted + held - 1) / std::max<std::int64_t>(1, held));
}

/// " key=value" for each setting of `b` that `a` has otherwise.
std::string differences(const Settings& a, const Settings& b) {
    const auto list = [](const Settings& s) {
        std::vector<std::string> texts;
        visit_settings(s, [&](const char* key, const auto& value, const auto&...) {
            texts.push_back(fmt::format(" {}={}", key, printable(value)));
        });
        return texts;
    };
    const std::vector<std::string> from = list(a), to = list(b);
    std::string text;
    for (std::size_t i = 0; i < to.size(); ++i)
        if (to[i] != from[i]) text += to[i];
    return text;
}

/// What a render with some effort cost.
struct Experience {
    double effort, seconds;
    double gather; ///< share of it that stage three took
};

constexpr double kFirst = 0.02; // effort of the first render, as a share of what should fill the time
/// Of the time that is left, so that a render that costs a little more than was foreseen is done in time.
constexpr double kUse = 0.93;
/// A render is worth its time if it has so much more effort than the one before it.
constexpr double kWorthwhile = 1.1;

/// The most effort that `seconds` are enough for, by the last two renders. After a first one that was short, a somewhat
/// longer one shows what effort costs; one that took a good part of the time did so by what comes once, for the most
/// part: what each pixel costs.
double affordable(const std::vector<Experience>& past, double seconds) {
    const Experience& last = past.back();
    if (past.size() == 1) {
        const double times = seconds / last.seconds;
        return last.effort * (times > 10 ? 3 : 2 * times - 1);
    }
    // Time grows as a power of effort, less than in proportion: parts come once, others grow more slowly. A prediction
    // that is too bold costs little, for chains and light paths end where what follows them needs the time.
    const Experience& before = past[past.size() - 2];
    const double power =
        std::clamp(std::log(last.seconds / before.seconds) / std::log(last.effort / before.effort), 0.65, 1.0);
    return last.effort * std::min(30.0, std::pow(seconds / last.seconds, 1 / power));
}

/// What all stages but the choice of a method, which is made once, took [s].
double without_choice(const RenderStats& stats, double seconds) {
    double all = 0, choice = 0;
    for (const StageStats& stage : stats.stages) {
        all += stage.wall_seconds;
        if (stage.name == "trial of samplers") choice += stage.wall_seconds;
    }
    return all > 0 ? seconds * (1 - choice / all) : seconds;
}

/// Share of the time that stage three took.
double gather_share(const RenderStats& stats) {
    double all = 0, gather = 0;
    for (const StageStats& stage : stats.stages) {
        if (stage.name == "trial of samplers") continue;
        all += stage.wall_seconds;
        if (stage.name == "gather") gather += stage.wall_seconds;
    }
    return all > 0 ? gather / all : 0;
}

/// What each pass of a render of some effort has to keep for stage three [s], should the stages before it cost more
/// than was foreseen.
double reserve_for_gather(const Experience& last, double effort, double seconds, std::int64_t passes) {
    const double foreseen = last.gather * last.seconds * std::pow(effort / last.effort, 0.75);
    return std::min(1.2 * foreseen, seconds / 2) / static_cast<double>(passes);
}

/// One line of all stages of a render that a better one takes the place of.
void add_stages(StageStats& sum, const RenderStats& stats) {
    for (const StageStats& stage : stats.stages) {
        sum.wall_seconds += stage.wall_seconds;
        sum.cpu_seconds += stage.cpu_seconds;
        sum.rays += stage.rays;
    }
}

/// CPU time of some stages [s].
double seconds_of(const RenderStats& stats, std::initializer_list<std::string_view> names) {
    double seconds = 0;
    for (const StageStats& stage : stats.stages)
        if (std::find(names.begin(), names.end(), stage.name) != names.end()) seconds += stage.cpu_seconds;
    return seconds;
}

/// The split with the least error for the time of a render with `balance`: squared errors fall as the reciprocal of
/// time, so the best times are as errors times the roots of times. Nothing changes where an error isn't known.
StageBalance rebalance(const StageBalance& balance, const RenderStats& stats) {
    const auto chains = stats.values.find("chains, error of block brightness");
    const double one = seconds_of(stats, {"brightness"}), two = seconds_of(stats, {"photons", "chains"});
    if (chains == stats.values.end() || !(chains->second > 0 && stats.brightness > 0 && one > 0 && two > 0))
        return balance;
    const double to_one = stats.brightness_error / stats.brightness * std::sqrt(one);
    const double to_two = chains->second * std::sqrt(two);
    const double share = to_one / (to_one + to_two);
    // Bounds, for what short renders say of their errors is vague; and groups of chains that agree too well, as those
    // do that have not mixed, think their error smaller than it is.
    return {std::clamp(balance.brightness * share * (one + two) / one, 0.25, 1.2),
            std::clamp(balance.chains * (1 - share) * (one + two) / two, 0.9, 4.0)};
}

bool has_empty_pixels(const RenderStats& stats) {
    const auto empty = stats.values.find("empty pixels");
    return empty != stats.values.end() && empty->second > 0;
}

} // namespace

Settings with_effort(const Settings& settings, double effort, std::int64_t pixels, const std::set<std::string>& given,
                     const StageBalance& balance) {
    Settings s = settings;
    const auto set = [&](const char* key, std::int64_t Settings::*member, double value, double least, double most) {
        if (!given.contains(key)) s.*member = static_cast<std::int64_t>(std::clamp(value, least, most));
    };
    // Small pictures get more samples a pixel, large ones fewer, so that photons and pixels share the time alike.
    const double spp = 8 * std::sqrt(effort * kPixels / static_cast<double>(pixels));
    const double photons = 80e3 * std::pow(effort, 0.6);
    const double passes =
        given.contains("passes") || !keeps_photons(s.method)
            ? 1
            : std::min(static_cast<double>(passes_for(static_cast<std::int64_t>(photons), s)), std::max(1.0, spp));
    set("passes", &Settings::passes, passes, 1, 1 << 20);
    set("spp", &Settings::spp, spp / passes, 1, 1 << 24);
    set("photons", &Settings::photons, photons / passes, 1000, 1 << 30);
    set("light_paths", &Settings::light_paths, 500e3 * effort / passes, 1000, 0x1p50);
    // Samples of all techniques, which stage one of these takes, cost as much as many of their steps.
    const bool multiplexed = s.method == "mmlt" || s.method == "rjmlt";
    set("mutations", &Settings::mutations, (multiplexed ? 1500e3 : 500e3) * effort * balance.chains / passes, 1000,
        0x1p50);
    set("brightness_samples", &Settings::brightness_samples,
        (multiplexed ? 50e3 : 100e3) * effort * balance.brightness / passes, 5000, 0x1p40);
    // However short the render: without them photons would be weighed, or looked for, by chance, which costs more.
    set("importons", &Settings::importons, 100e3 * effort / passes, 50e3, 1 << 30);
    set("cache_rays", &Settings::cache_rays, 1600 * std::pow(effort, 0.7) / std::sqrt(passes), 64, 1 << 20);
    return s;
}

Settings with_quality(const Settings& settings, const std::string& quality, const std::set<std::string>& given) {
    for (const auto& [name, effort] : {std::pair("draft", 0.5), {"good", 4.0}, {"final", 24.0}})
        if (quality == name) return with_effort(settings, effort, static_cast<std::int64_t>(kPixels), given);
    throw InputError("found quality '" + quality + "', expected draft, good or final");
}

RenderResult render_in_time(Scene& scene, const Settings& settings, const std::set<std::string>& given,
                            const RunContext& context, const UserPathFile& user_paths, const Share& share) {
    Settings s = settings;
    if (s.method == "path" || s.method == "bdpt") {
        if (!given.contains("spp")) s.spp = 1 << 24; // as many as there is time for
        return render(scene, s, context, user_paths, share);
    }
    const ImageWindow& window = scene.camera().window();
    const std::int64_t pixels = std::int64_t{window.width} * window.height;
    if (!given.contains("brightness_error")) s.brightness_error = 0; // stage one gets its part of the time, no more
    std::vector<Experience> past;
    StageBalance balance;
    std::optional<RenderResult> best;
    StageStats others{.name = "trials of settings"};
    double effort = kFirst * context.stop->seconds_left() / kSecondsOfEffort;
    while (true) {
        const double start = context.stop->seconds_left();
        const Settings chosen = with_effort(s, effort, pixels, given, balance);
        RunContext limited = context;
        if (!past.empty() && keeps_photons(s.method)) {
            limited.reserve = reserve_for_gather(past.back(), effort, start, chosen.passes);
            limited.whole_round = true; // the render before had one, and time left: photons are worth that little more
        }
        RenderResult result = render(scene, chosen, limited, user_paths, share);
        s.method = result.stats.method; // what `auto` stands for
        const double left = context.stop->seconds_left();
        // Where time was up before each pixel had a sample, the picture before is the better one.
        if (best && has_empty_pixels(result.stats)) {
            add_stages(others, result.stats);
            break;
        }
        result.stats.values["effort"] = effort;
        result.stats.remarks.push_back("set by the time:" + differences(settings, chosen));
        if (best) add_stages(others, best->stats);
        past.push_back({effort, without_choice(result.stats, start - left), gather_share(result.stats)});
        balance = rebalance(balance, result.stats);
        best = std::move(result);
        const double next = affordable(past, kUse * left);
        if (context.stopped() || next < kWorthwhile * effort) break;
        effort = next;
    }
    auto& stages = best->stats.stages;
    if (others.wall_seconds > 0) stages.insert(stages.begin(), others);
    return std::move(*best);
}

} // namespace keyhole
