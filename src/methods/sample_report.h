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
/// @param looks_through whether direct light is looked for through clear glass, too.
void report_lost_caustics(const Scene& scene, RenderStats& stats, bool looks_through = false);

/// Warns of what methods hardly find that join paths from the eye to the light, and look through no clear glass then:
/// what gloss shows of a place in the sun, if the sun shines in through a pane. Its light comes along a path from the
/// sun alone, which the eye sees in a narrow lobe.
void report_sun_behind_glass(const Scene& scene, RenderStats& stats);

} // namespace keyhole
