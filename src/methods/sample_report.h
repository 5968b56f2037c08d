// Whether samples of pixels can be trusted.
#pragma once

#include "core/render_stats.h"
#include "core/statistics.h"
#include "scene/scene.h"

namespace keyhole {

/// Warns where samples are so unequal that even the mean of the picture isn't known.
/// @param luminance of all samples of pixels [W/(m^2 sr)].
void report_samples(const RunningStats& luminance, RenderStats& stats);

/// The same where emitters are seen only by rays from the eye. Warns also where these are so small that hardly a sample
/// meets them: of such the samples themselves know nothing.
void report_eye_samples(const RunningStats& luminance, const Scene& scene, RenderStats& stats);

/// Of methods that find all light by paths traced from the eye, joined to the light or not: warns where they found
/// none, and where there is light that they can't find, what comes from emitters without extent through specular
/// surfaces.
void report_lost_light(const RunningStats& luminance, const Scene& scene, RenderStats& stats);

} // namespace keyhole
