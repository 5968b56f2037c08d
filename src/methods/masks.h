// What covers each pixel: alpha, and ids of objects and materials.
#pragma once

#include "core/progress.h"
#include "core/settings.h"
#include "film/picture.h"
#include "scene/scene.h"

namespace keyhole {

/// Adds the layer "alpha" where the camera doesn't see its surroundings, and the Cryptomatte layers that the settings
/// ask for, by `mask_rays` rays a pixel, distributed as the filter. What is seen first counts, glass like all else. The
/// same whatever else the picture was made with. Nothing is added if somebody asks to stop meanwhile.
void add_masks(Picture& picture, const Scene& scene, const Settings& settings, const StopToken& stop);

} // namespace keyhole
