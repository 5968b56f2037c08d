// Light of emitters without extent on specular surfaces.
#pragma once

#include "scene/scene.h"

namespace keyhole {

/// Whether light may come straight from an emitter that no ray can hit to a surface that reflects or lets through as a
/// mirror or smooth glass does. False where none was found on rays from such emitters, nor from points of such
/// surfaces; true where there is too much of either to look at.
bool may_light_specular(const Scene& scene);

} // namespace keyhole
