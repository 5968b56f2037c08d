#include "methods/learned_direct_light_scope.h"

#include "methods/each_emitter.h"
#include "methods/method.h"
#include "sampling/guidance/learned/look_for_direct_light.h"
#include "sampling/paths/direct_light.h"
#include "session/stage_clock.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace keyhole {
namespace {

constexpr Stage kLearning{"direct light, learned"};

/// Of the time, and of the samples of pixels where there is no limit to the time.
constexpr double kTimeShare = 0.04, kSampleShare = 1.0 / 16;
/// Paths at most, and fewer than which are not worth their while.
constexpr std::int64_t kMostPaths = std::int64_t{1} << 18, kLeastPaths = 1024;
/// What is learned may take this share of the memory for photons.
constexpr std::int64_t kMemoryShare = 10;

DirectLightLearning learning(const Settings& settings, const ImageWindow& window, const RunContext& context) {
    DirectLightLearning l{.paths = kMostPaths,
                          .max_scatterings = static_cast<int>(settings.max_depth),
                          .seed = static_cast<std::uint64_t>(settings.seed),
                          .most_bytes = static_cast<std::size_t>(settings.photon_memory / kMemoryShare)};
    const double left = context.seconds_left();
    if (std::isfinite(left)) {
        l.seconds = kTimeShare * left;
    } else {
        const double samples = window.size() * static_cast<double>(settings.spp) *
                               static_cast<double>(std::max<std::int64_t>(1, settings.passes));
        l.paths = static_cast<std::int64_t>(std::min(static_cast<double>(kMostPaths), kSampleShare * samples));
        if (l.paths < kLeastPaths) l.paths = 0;
    }
    return l;
}

} // namespace

LearnedDirectLightScope::LearnedDirectLightScope(Scene& scene) : scene_(scene) {
    scene.set_direct_light(nullptr);
    scene.set_takes_each_emitter(false);
}

LearnedDirectLightScope::LearnedDirectLightScope(Scene& scene, const Settings& settings, const RunContext& context)
    : LearnedDirectLightScope(scene) {
    // Methods with photon maps trace no such paths; what `auto` stands for may.
    const bool traces_paths = settings.method == &methods::automatic || !settings.method->keeps_photons;
    const bool may_take_each = traces_paths && has_few_emitters(scene);
    if (!settings.method->asks_for_direct_light || !(may_take_each || has_choice_of_direct_light(scene))) return;
    const StageClock clock(own_, kLearning);
    learn(settings, context);
    if (!may_take_each || !each_emitter_pays(scene, settings, context)) return;
    scene.set_takes_each_emitter(true);
    own_.remarks.emplace_back("direct light: paths have a sample of each emitter at what is seen first");
}

void LearnedDirectLightScope::learn(const Settings& settings, const RunContext& context) {
    if (!has_choice_of_direct_light(scene_)) return;
    learned_ = learn_direct_light(scene_, learning(settings, scene_.camera().window(), context), context);
    if (!learned_) return;
    own_.values["direct_light_second_moment"] = learned_->second_moment_ratio();
    own_.values["direct_light_bytes"] = static_cast<double>(learned_->bytes());
    own_.remarks.push_back(fmt::format("direct light: learned in {} cells, {:.2g} times fewer shadow rays for the same "
                                       "second moment",
                                       learned_->cells(), 1 / learned_->second_moment_ratio()));
    scene_.set_direct_light(learned_);
}

} // namespace keyhole
