#include "render/effort.h"

#include "core/error.h"
#include "render/memory_plan.h"
#include "render/stage_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace keyhole {
namespace {

constexpr double kPixels = 320 * 240;  // of the picture that effort is measured by
constexpr double kSecondsOfEffort = 5; // CPU time of a unit on it

bool draws_photons(const std::string& method) {
    return method == "auto" || method == "mps" || method == "ipm" || method == "pm";
}

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

/// What effort costs here: a part that is always the same, and a share for each unit.
struct Cost {
    double fixed = 0, per_effort = 0; // [s]
};

/// Effort of the two trials, as a share of what should fill the time. The first shows what is always the same.
constexpr double kFirstTrial = 0.005, kSecondTrial = 0.04;
/// Share of the time that a first trial may take if there is to be a second.
constexpr double kAffordable = 0.08;
/// Of the time that is left after them, so that a render that costs a little more than they said is done in time.
constexpr double kUse = 0.93;

/// Renders with little effort that tell what effort costs; their pictures are thrown away, unless there is no other.
class Trials {
  public:
    Trials(Scene& scene, const std::set<std::string>& given, const RunContext& context, const UserPathFile& user_paths)
        : scene_(scene), given_(given), context_(context), user_paths_(user_paths) {}

    /// Puts what `auto` stands for into `settings`. None if time was up: then last() is what there is.
    std::optional<Cost> run(Settings& settings) {
        const double total = context_.stop->seconds_left(), unit = total / kSecondsOfEffort;
        const StageClock clock(stats_, "trials of settings");
        const double first = render_with(settings, kFirstTrial * unit);
        if (context_.stopped()) return std::nullopt;
        // Without time for another trial, effort costs what it usually does, and a little more.
        if (first > kAffordable * total) return Cost{0.85 * first, 1.3 * kSecondsOfEffort};
        const double second = render_with(settings, kSecondTrial * unit);
        if (context_.stopped()) return std::nullopt;
        const double slope =
            std::max(0.1 * second / (kSecondTrial * unit), (second - first) / ((kSecondTrial - kFirstTrial) * unit));
        return Cost{std::max(0.0, second - slope * kSecondTrial * unit), slope};
    }
    RenderResult& last() { return last_; }
    const RenderStats& stats() const { return stats_; }

  private:
    /// What it cost, without the choice of a method, which is made once.
    double render_with(Settings& settings, double effort) {
        const double start = context_.stop->seconds_left();
        const ImageWindow& window = scene_.camera().window();
        const Settings trial = with_effort(settings, effort, std::int64_t{window.width} * window.height, given_);
        last_ = render(scene_, trial, context_, user_paths_);
        settings.method = last_.stats.method;
        double all = 0, choice = 0;
        for (const StageStats& stage : last_.stats.stages) {
            all += stage.wall_seconds;
            if (stage.name == "trial of samplers") choice = stage.wall_seconds;
        }
        return (start - context_.stop->seconds_left()) * (all > 0 ? 1 - choice / all : 1);
    }

    Scene& scene_;
    const std::set<std::string>& given_;
    const RunContext& context_;
    const UserPathFile& user_paths_;
    RenderResult last_;
    RenderStats stats_;
};

bool has_empty_pixels(const RenderStats& stats) {
    const auto empty = stats.values.find("empty pixels");
    return empty != stats.values.end() && empty->second > 0;
}

} // namespace

Settings with_effort(const Settings& settings, double effort, std::int64_t pixels, const std::set<std::string>& given) {
    Settings s = settings;
    const auto set = [&](const char* key, std::int64_t Settings::*member, double value, double least, double most) {
        if (!given.contains(key)) s.*member = static_cast<std::int64_t>(std::clamp(value, least, most));
    };
    // Small pictures get more samples a pixel, large ones fewer, so that photons and pixels share the time alike.
    const double spp = 4 * effort * std::sqrt(kPixels / static_cast<double>(pixels));
    const double photons = 80e3 * std::pow(effort, 0.6);
    const double passes =
        given.contains("passes") || !draws_photons(s.method)
            ? 1
            : std::min(static_cast<double>(passes_for(static_cast<std::int64_t>(photons), s)), std::max(1.0, spp));
    set("passes", &Settings::passes, passes, 1, 1 << 20);
    set("spp", &Settings::spp, spp / passes, 1, 1 << 24);
    set("photons", &Settings::photons, photons / passes, 1000, 1 << 30);
    set("light_paths", &Settings::light_paths, 500e3 * effort / passes, 1000, 0x1p50);
    // Samples of all techniques, which stage one of these takes, cost as much as many of their steps.
    const bool multiplexed = s.method == "mmlt" || s.method == "rjmlt";
    set("mutations", &Settings::mutations, (multiplexed ? 1500e3 : 500e3) * effort / passes, 1000, 0x1p50);
    set("brightness_samples", &Settings::brightness_samples, (multiplexed ? 50e3 : 100e3) * effort / passes, 5000,
        0x1p40);
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
    Trials trials(scene, given, context, user_paths);
    const std::optional<Cost> cost = trials.run(s);
    if (!cost) return std::move(trials.last());
    const double effort = std::max(1e-3, (kUse * context.stop->seconds_left() - cost->fixed) / cost->per_effort);
    const ImageWindow& window = scene.camera().window();
    const Settings chosen = with_effort(s, effort, std::int64_t{window.width} * window.height, given);
    RenderResult result = render(scene, chosen, context, user_paths, share);
    if (has_empty_pixels(result.stats)) return std::move(trials.last()); // even the first round took too long
    RenderStats& stats = result.stats;
    stats.stages.insert(stats.stages.begin(), trials.stats().stages.begin(), trials.stats().stages.end());
    stats.values["effort"] = effort;
    stats.remarks.push_back("set by the time:" + differences(settings, chosen));
    return result;
}

} // namespace keyhole
