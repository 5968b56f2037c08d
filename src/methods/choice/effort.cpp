#include "methods/choice/effort.h"

#include "methods/method.h"
#include "methods/photons/memory_plan.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

constexpr double kPixels = 320 * 240; // of the picture that effort is measured by

/// Light paths of a unit of effort. Gather rays average over so many photons that more paths bring less than more
/// samples of pixels would.
constexpr double kLightPaths = 350e3;
/// Photons of a unit of effort that there have to be, in several passes if the memory doesn't hold them at once; and
/// those that are kept where it does, which blur less, at most so many of a light path.
constexpr double kPhotonsNeeded = 100e3, kPhotonsKept = 250e3, kPhotonsOfPath = 0.5;

/// Photons that the memory holds at a time.
double photons_held(Settings settings) {
    settings.photons = 0;
    return std::max(1.0, static_cast<double>(plan_memory(settings, settings.method->importance, 2).photons));
}

} // namespace

Settings with_effort(const Settings& settings, double effort, std::int64_t pixels, const std::set<std::string>& given,
                     const StageBalance& balance) {
    Settings s = settings;
    const auto set = [&](const char* key, std::int64_t Settings::*member, double value, double least, double most) {
        if (!given.contains(key)) s.*member = static_cast<std::int64_t>(std::clamp(value, least, most));
    };
    // Small pictures get more samples a pixel, large ones fewer, so that photons and pixels share the time alike.
    const double spp = 12 * std::sqrt(effort * kPixels / static_cast<double>(pixels));
    const double growth = std::pow(effort, 0.7), held = photons_held(s);
    const double passes = given.contains("passes") || !s.method->keeps_photons
                              ? 1
                              : std::min(std::ceil(kPhotonsNeeded * growth / held), std::floor(std::max(1.0, spp)));
    set("passes", &Settings::passes, passes, 1, 1 << 20);
    set("spp", &Settings::spp, spp / passes, 1, 1 << 24);
    set("photons", &Settings::photons,
        std::min({kPhotonsKept * growth / passes, kPhotonsOfPath * kLightPaths * effort / passes, held}), 1000,
        1 << 30);
    set("light_paths", &Settings::light_paths, kLightPaths * effort / passes, 1000, 0x1p50);
    set("mutations", &Settings::mutations, s.method->mutations_of_effort * effort * balance.chains / passes, 1000,
        0x1p50);
    set("brightness_samples", &Settings::brightness_samples,
        s.method->brightness_samples_of_effort * effort * balance.brightness / passes, 5000, 0x1p40);
    // More of them where the render is short: without them photons would be weighed, or looked for, by chance. But on
    // finely meshed scenes a path of theirs takes ten times as long as one of light.
    set("importons", &Settings::importons, 100e3 * effort / passes, std::clamp(200e3 * effort, 8e3, 25e3), 1 << 30);
    // Where there is time for few rays, they are better spent on few records than on poor ones.
    if (!given.contains("cache_error"))
        s.cache_error = Settings().cache_error * std::clamp(std::pow(effort, -0.3), 1.0, 2.0);
    // In corners and along edges light changes within the least reach of records: the area where they are wrong goes
    // with it, and so does their squared error. Where there is little time, more records would be noise.
    if (!given.contains("cache_min_reach"))
        s.cache_min_reach = Settings().cache_min_reach * std::clamp(std::pow(effort, -0.75), 0.125, 1.0);
    set("cache_rays", &Settings::cache_rays, 1500 * std::pow(effort, 0.7) / std::sqrt(passes), 64, 1 << 20);
    return s;
}

Settings with_effort_at_most(const Settings& settings, double effort, std::int64_t pixels,
                             const std::set<std::string>& given) {
    Settings s = with_effort(settings, effort, pixels, given);
    for (const auto member : {&Settings::spp, &Settings::light_paths, &Settings::mutations,
                              &Settings::brightness_samples, &Settings::importons, &Settings::cache_rays})
        s.*member = std::min(s.*member, settings.*member);
    if (settings.photons > 0) s.photons = std::min(s.photons, settings.photons);
    s.cache_error = std::max(s.cache_error, settings.cache_error);
    s.cache_min_reach = std::max(s.cache_min_reach, settings.cache_min_reach);
    return s;
}

double effort_of_pass(double target_error) {
    constexpr double kErrorOfUnit = 0.04; // what a unit of effort leaves, about, in scenes that are not easy
    return std::pow(kErrorOfUnit / target_error, 2);
}

Settings with_quality(const Settings& settings, Quality quality, const std::set<std::string>& given) {
    const double effort = quality == Quality::draft ? 0.5 : quality == Quality::good ? 4 : 24;
    Settings s = with_effort(settings, effort, static_cast<std::int64_t>(kPixels), given);
    if (quality == Quality::draft && !given.contains("denoise")) s.denoise = Denoise::exr;
    return s;
}

} // namespace keyhole
