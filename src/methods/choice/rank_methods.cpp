#include "methods/choice/rank_methods.h"

#include "methods/choice/filtered_grain.h"
#include "methods/method.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

/// What photons and records err falls as this power of the effort at least: often faster while they are few, but two
/// renders don't tell what both have wrong.
constexpr double kSlope = 0.85;
/// What they blur falls as this power. Beside the edge of a shadow the squared error is as wide as the radius of
/// lookups, whose area falls as photons are more: those of with_effort().
constexpr double kBlurSlope = 0.35;
/// Of the grain that a trial shows, what stays at least where pixels of the picture are smaller.
constexpr double kLeastGrain = 0.3;

/// How far the part of the squared error falls that neighbours share: half as effort says, half with the rays of
/// records, whose noise it is as well. Where the time goes to samples of pixels, these hardly grow.
double fall_of_blotches(double effort, double rays) {
    const double by_effort = std::pow(effort, -kSlope);
    return std::sqrt(by_effort * std::max(by_effort, 1 / rays));
}

/// The squared error in the time that is left as a trial shows it.
double predict_by_trial(const TriedMethod& t, const TrialContext& c, double left) {
    const double pixels = c.scene.camera().window().size();
    const double time = t.of.taken / left, size = pixels / t.of.cost.pixels;
    const TrialError& e = t.error;
    // Where dots come closer than one to a block of the trial, they are grain.
    const double dots = e.dots * std::min(1.0, kTrialBlock * time * size);
    if (t.method->samples_pixels) {
        // Light that was missed is that of rare, bright samples, and grain where they are found.
        const double missing = e.missing * t.of.cost.pixels / kTrialParts;
        return (grain_that_counts(c.settings, *t.method) * e.grain + e.blotches + missing) * time * size + dots;
    }
    if (!t.method->keeps_photons)
        return t.method->trial.doubt * (e.grain * time * size + (e.blotches + e.missing) * time + dots);
    Settings s = c.settings;
    s.method = t.method;
    double effort = 0;
    s = t.of.settings_for(s, c.given, pixels, left, effort);
    const double samples = static_cast<double>(s.spp * std::max<std::int64_t>(1, s.passes)) / t.of.samples;
    const double growth = effort / t.of.cost.effort;
    const double of_samples = grain_that_counts(c.settings, *t.method) * t.by_samples / samples;
    const double rays = static_cast<double>(s.cache_rays) / static_cast<double>(t.of.cost.settings.cache_rays);
    return t.method->trial.doubt *
           (e.grain * (of_samples + (1 - t.by_samples) / growth) +
            (e.blotches + e.missing) * fall_of_blotches(growth, rays) + e.blur * std::pow(growth, -kBlurSlope));
}

/// The squared error in the time that is left, told from that of a trial. What isn't led through the openings that were
/// found misses most of the light in a short one: its picture is dark and quiet, and its error larger than it seems.
double predict(const TriedMethod& t, const TrialContext& c, double left, const RankLimits& limits) {
    const double hidden = t.method->follows_user_paths ? 1 : std::sqrt(c.findings.gain_by_openings);
    // Of what photons err, part is common to passes, part goes with their number: half of it by powers.
    if (t.method->keeps_photons)
        return hidden * predict_by_trial(t, c, left / limits.passes) / std::sqrt(limits.passes);
    if (t.method->samples_pixels)
        left = std::min(left, limits.samples * t.of.per_sample(c.scene.camera().window().size()));
    return hidden * predict_by_trial(t, c, left);
}

/// What the variance of a sample has of differences within a pixel of the small window that a pixel of the picture,
/// which is smaller, doesn't have: the same for all methods that sample pixels.
double variance_within_pixels(std::span<const TriedMethod> tried) {
    const auto path = std::ranges::find(tried, &methods::path, &TriedMethod::method);
    if (path == tried.end() || !path->narrow) return 0;
    return variance_less(path->pictures, *path->narrow) * path->of.samples;
}

/// What photons blur, by the method that samples pixels best.
double blur_of(const TriedMethod& photons, std::span<const TriedMethod> tried) {
    const TriedMethod* best = nullptr;
    const auto error = [](const TriedMethod& t) { return t.error.grain + t.error.blotches + t.error.missing; };
    for (const TriedMethod& t : tried)
        if (t.method->samples_pixels && t.narrow && (best == nullptr || error(t) < error(*best))) best = &t;
    return best != nullptr && photons.narrow ? blur(*photons.narrow, *best->narrow) : 0;
}

} // namespace

void rank_methods(std::vector<TriedMethod>& tried, const TrialContext& c, double left, const RankLimits& limits) {
    std::vector<TrialPictures> pictures;
    for (const TriedMethod& t : tried) {
        pictures.push_back(t.pictures);
        pictures.back().rare_samples = t.method->samples_pixels;
        pictures.back().by_photons = t.method->keeps_photons;
    }
    const std::vector<TrialError> errors = trial_errors(pictures);
    const double within = variance_within_pixels(tried);
    for (std::size_t i = 0; i < tried.size(); ++i) tried[i].error = errors[i];
    for (std::size_t i = 0; i < tried.size(); ++i) {
        if (tried[i].method->keeps_photons) tried[i].error.blur = blur_of(tried[i], tried);
        double& grain = tried[i].error.grain;
        if (tried[i].method->keeps_photons || tried[i].method->samples_pixels)
            grain = std::max(kLeastGrain * grain, grain - within / tried[i].of.samples);
        tried[i].predicted = predict(tried[i], c, left, limits);
    }
    std::ranges::stable_sort(tried, {}, &TriedMethod::predicted);
    // Where nobody found any, it is for those who look from both ends.
    if (share_lit(pictures) > 0) return;
    const auto bdpt = std::ranges::find(tried, &methods::bdpt, &TriedMethod::method);
    if (bdpt != tried.end()) std::rotate(tried.begin(), bdpt, bdpt + 1);
}

} // namespace keyhole
