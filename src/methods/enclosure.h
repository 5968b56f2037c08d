// Cameras that no light can reach.
#pragma once

#include "scene/scene.h"

namespace keyhole {

/// The shape around the camera that keeps all light away, null where there is none for certain: a closed mesh that
/// nothing goes through, and no emitter anywhere near its inside.
const Shape* dark_enclosure(const Scene& scene);

} // namespace keyhole
