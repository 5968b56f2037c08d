// How a render by chains shares its time between finding out the brightness and running them.
#pragma once

#include "core/render_stats.h"
#include "methods/choice/effort.h"
#include "methods/choice/experience.h"

namespace keyhole {

/// The split with the least error for the time of a render with `balance`, by the errors that it had: squared errors
/// fall as the reciprocal of time, so the best times are as errors times the roots of times. Nothing changes where an
/// error isn't known. `caustics`: whether there may be any, of which a short render may have missed the brightest.
StageBalance rebalance(const StageBalance& balance, const RenderStats& stats, bool caustics);

/// `settings` with the time of stage three split between records of the irradiance cache and samples of pixels such
/// that their squared errors add up to the least, told from the noise that a render whose cost is known had. Settings
/// named in `given` stay as they are.
/// @param pixels of the picture.
Settings split_stage_three(const Settings& settings, const Experience& cost, const PhotonQuality::Noise& noise,
                           double pixels, const std::set<std::string>& given);

/// RunContext::rays_for_pixel of a render with so many samples of a pixel, by the same noise; infinite where samples
/// have none.
double rays_for_pixel(const PhotonQuality::Noise& noise, const Experience& cost, double spp);

} // namespace keyhole
