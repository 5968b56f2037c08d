#include "methods/render_paths.h"

#include "methods/method.h"
#include "sampling/guidance/found/find_openings.h"
#include "sampling/guidance/found/guidance_gain.h"
#include "sampling/guidance/found/passages.h"
#include "session/stage_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace keyhole {
namespace {

constexpr Stage kOpenings{"openings"};

/// Of the time, and pairs of places for each light path where there is no limit to the time.
constexpr std::int64_t kPaths = 1024; // from either end
constexpr double kTimeOfLooking = 0.02;
constexpr std::int64_t kLightPathsOfPair = 8, kMostPairs = std::int64_t{1} << 20;
/// However few light paths there are: behind a letterbox of 30 x 4 cm one pair in 20,000 finds through, and an opening
/// takes two. With half as many 2 seeds of 8 missed it. They take 60 ms.
constexpr std::int64_t kLeastPairs = 131'072;
/// That learn where light paths would begin without openings.
constexpr std::int64_t kPathsOfLearning = 4096;

bool has_emitters_with_a_place(const Scene& scene) {
    return std::ranges::any_of(scene.emitters(), [](const auto& e) { return e->site() != Site::infinite; });
}

double sum_of_weights(const UserPathFile& file) {
    double sum = 0;
    for (const UserPathSpec& path : file.paths) sum += path.weight;
    return sum;
}

/// Both, each as often as the other.
UserPathFile joined(const UserPathFile& given, const UserPathFile& found) {
    UserPathFile both = given;
    const double scale = sum_of_weights(given) / sum_of_weights(found);
    for (const UserPathSpec& path : found.paths) {
        both.paths.push_back(path);
        both.paths.back().weight *= scale;
    }
    return both;
}

std::string through(int openings) {
    return openings == 1 ? "through an opening that was found"
                         : fmt::format("through {} openings that were found", openings);
}

OpeningSearch search_of(const Settings& settings, const RunContext& context) {
    OpeningSearch search{
        .pairs = kMostPairs, .max_scatterings = static_cast<int>(settings.max_depth), .seed = settings.seed};
    const double left = context.seconds_left();
    if (std::isfinite(left))
        search.seconds = kTimeOfLooking * left;
    else
        search.pairs = std::clamp(settings.light_paths / kLightPathsOfPair, kLeastPairs, kMostPairs);
    return search;
}

/// Where light paths begin that aren't led, if that can be learned: many lamps are far away, and openings between them
/// and the eye are only worth having if paths from those that matter don't find through.
std::optional<LearnedEmission> emission_without_openings(const Scene& scene, const Settings& settings,
                                                         const RunContext& context) {
    if (!LearnedEmission::can_learn(scene)) return std::nullopt;
    FoundLightPaths found = look_for_light(
        scene,
        {.paths = kPathsOfLearning, .max_scatterings = static_cast<int>(settings.max_depth), .seed = settings.seed},
        context);
    return std::optional<LearnedEmission>(std::in_place, scene, std::move(found.ends));
}

} // namespace

RenderPaths::RenderPaths(const Scene& scene, const Settings& settings, const UserPathFile& given,
                         const RunContext& context)
    : paths_(bind_user_paths(scene, given)) {
    if (!paths_.empty() && !settings.method->follows_user_paths)
        own_.remarks.push_back(fmt::format("user paths have no effect on method {}; expected one of {}",
                                           settings.method->name, names_of(&Method::follows_user_paths)));
    else if (!paths_.empty() && !settings.load_map.empty())
        own_.remarks.emplace_back("user paths have no effect with --load-map: the photons of the file are there");
    if (!settings.find_openings || !settings.method->follows_user_paths || !settings.load_map.empty() ||
        scene.has_scattering_media() || !has_emitters_with_a_place(scene))
        return;
    const StageClock clock(own_, kOpenings);
    OpeningSearch search = search_of(settings, context);
    const TransportEnds ends = trace_transport_ends(scene, kPaths, search.seed, context);
    if (light_finds_its_way(scene, ends, search.seed, context)) return;
    const std::optional<LearnedEmission> learned = emission_without_openings(scene, settings, context);
    if (learned) search.learned = &*learned;
    search.known = openings_of(given);
    const auto gain = [&] {
        return std::max(
            1.0, gain_by_guides(scene, LightGuides(scene, paths_), ends.eye, search.seed, context, search.learned));
    };
    const bool is_given = !paths_.empty();
    if (!search.known.empty()) own_.values["gain by user paths"] = own_.values["gain by openings"] = gain_ = gain();
    const OpeningsFound found = find_openings(scene, ends, search, context);
    if (found.paths.paths.empty()) {
        say_led("along user paths", gain_);
        return;
    }
    paths_ = bind_user_paths(scene, is_given ? joined(given, found.paths) : found.paths);
    own_.values["openings found"] = found.openings;
    own_.values["gain by openings"] = gain_ = is_given ? gain() : found.gain;
    // What paths of the user's gain alone was measured without the light that comes elsewhere, and may be far too much.
    say_led(through(found.openings) + (is_given ? ", beside the paths that are given" : ""), gain_);
}

void RenderPaths::say_led(const std::string& where, double gain) {
    constexpr double kGain = 1.05; // what is less reads "1 times"
    if (gain >= kGain)
        own_.remarks.push_back(fmt::format("light is led {}: {:.2g} times fewer light paths do as well", where, gain));
}

} // namespace keyhole
