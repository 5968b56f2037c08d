// From a scene and settings to a picture.
#pragma once

#include "core/progress.h"
#include "core/render_stats.h"
#include "core/settings.h"
#include "film/picture.h"
#include "scene/load/yaml/user_path_file.h"
#include "scene/scene.h"
#include "session/work_partition.h"

namespace keyhole {

struct RenderResult {
    Picture picture;
    RenderStats stats;
    Settings settings; ///< that it was made with
};

/// Sets the margin of the scene's window: room for the filter, and for photon lookups at the border of the picture.
void set_window_margin(Scene& scene, const Settings& settings);

/// Renders by the method that the settings name. The same scene, settings and seed give the same picture, bit for bit,
/// whatever the number of threads. After a stop the result is what there is so far, with stats.complete false. Sets the
/// scene's window margin. Methods that run chains are guided by `user_paths`.
/// Renders only the part that `share` asks for.
/// @throws InputError for user paths that can't work in the scene, and a `share.done` of another render.
RenderResult render(Scene& scene, const Settings& settings, const RunContext& context,
                    const UserPathFile& user_paths = {}, const WorkPartition& share = {});

} // namespace keyhole
