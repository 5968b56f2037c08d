// Whether samples of pixels can be trusted.
#pragma once

#include "core/render_stats.h"
#include "core/statistics.h"
#include "scene/scene.h"

namespace keyhole {

/// Warns where samples are so unequal that even the mean of the picture isn't known; of a camera that is walled in,
/// where a ray in a million slips through an edge, that it is.
/// @param luminance of all samples of pixels [W/(m^2 sr)].
void report_samples(const RunningStats& luminance, const Scene& scene, RenderStats& stats);

/// The same where emitters are seen only by rays from the eye. Warns also where these are so small that hardly a sample
/// meets them: of such the samples themselves know nothing.
void report_eye_samples(const RunningStats& luminance, const Scene& scene, RenderStats& stats);

/// Warns where the picture is black: paths traced from the eye, joined to the light or not, found none, and no photons
/// either if there are any.
void report_black(const RunningStats& luminance, const Scene& scene, RenderStats& stats, bool photons = false);

/// Warns of light that methods can't find whose paths are traced from the eye or joined to it: what comes from emitters
/// without extent through specular surfaces, if not from everywhere, then onto what is seen in others.
void report_lost_caustics(const Scene& scene, RenderStats& stats);

} // namespace keyhole
