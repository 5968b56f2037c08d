// The best picture for a time.
#pragma once

#include "core/settings.h"
#include "render/render.h"

#include <set>
#include <string>

namespace keyhole {

/// Renders with as much effort as fits in context.stop->seconds_left(). A small trial shows what effort costs in this
/// scene, and chooses the method for `auto`; a render follows with what is foreseen to fill the time, and others in
/// what is left then, as long as that is worth it. The result is their mean, weighted by their efforts. Where chains
/// are run, stage one and they share time so that their errors, as the render before had them, shrink together. Where
/// even the first doesn't fit, the result is what there was when time was up.
/// @param given settings that stay as they are.
/// @param share for its look(); all passes are done here.
/// @throws as render().
RenderResult render_in_time(Scene& scene, const Settings& settings, const std::set<std::string>& given,
                            const RunContext& context, const UserPathFile& user_paths = {}, const Share& share = {});

} // namespace keyhole
