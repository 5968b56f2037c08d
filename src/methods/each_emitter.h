// Whether what is seen first should have a sample of each emitter.
#pragma once

#include "core/progress.h"
#include "core/settings.h"
#include "scene/scene.h"

namespace keyhole {

/// By a trial of some thousand paths: true where the noise of choosing one of few emitters costs more than their rays
/// do; false where a trial would take too much of the time. Work is measured in rays, so that without a time the answer
/// is the same on every machine and on any number of threads. Leaves the scene as it was. @throws Interrupted
bool each_emitter_pays(Scene& scene, const Settings& settings, const RunContext& context);

} // namespace keyhole
