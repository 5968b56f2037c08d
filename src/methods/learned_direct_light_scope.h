// What a render learns of direct light before it begins.
#pragma once

#include "core/progress.h"
#include "core/render_stats.h"
#include "core/settings.h"
#include "sampling/guidance/learned/learned_direct_light.h"
#include "scene/scene.h"

namespace keyhole {

/// By a trial of some thousand paths: true where the noise of choosing one of few emitters costs more than their rays
/// do; false where a trial would take too much of the time. Work is measured in rays, so that without a time the answer
/// is the same on every machine and on any number of threads. Leaves the scene as it was. @throws Interrupted
bool each_emitter_pays(Scene& scene, const Settings& settings, const RunContext& context);

/// While it lives, the scene draws points on emitters as has been learned, if there is a choice to be learned, the
/// method that the settings name asks for direct light, and learning promises to pay; and paths have a sample of each
/// emitter at what is seen first where that pays (each_emitter_pays()).
class LearnedDirectLightScope {
  public:
    /// With a limit to the time a small share of it goes into learning, else of the samples of pixels.
    /// @throws Interrupted
    LearnedDirectLightScope(Scene& scene, const Settings& settings, const RunContext& context);
    ~LearnedDirectLightScope() {
        scene_.set_direct_light(nullptr);
        scene_.set_takes_each_emitter(false);
    }
    LearnedDirectLightScope(const LearnedDirectLightScope&) = delete;
    LearnedDirectLightScope& operator=(const LearnedDirectLightScope&) = delete;

    /// Null: nothing was learned.
    const LearnedDirectLight* learned() const { return learned_.get(); }

    /// Adds what learning took, and what it found.
    void report(RenderStats& stats) const { stats.begin_with(own_); }

  private:
    /// Nothing is learned. Once this is done the destructor clears the scene, whatever is thrown later.
    explicit LearnedDirectLightScope(Scene& scene);
    void learn(const Settings& settings, const RunContext& context);

    Scene& scene_;
    RenderStats own_;
    std::shared_ptr<const LearnedDirectLight> learned_;
};

} // namespace keyhole
