// Light from all around.
#pragma once

#include "scene/emitter.h"

namespace keyhole {

/// The same radiance [W/(m^2 sr)] from every direction; directions are uniform on the sphere.
std::unique_ptr<Emitter> make_constant_environment(const Rgb& radiance);

/// Several environments as one, since a ray that misses everything meets them all: their radiances add up, and
/// directions come from a mixture of their densities by power.
std::unique_ptr<Emitter> make_environment_sum(std::vector<std::unique_ptr<Emitter>> environments);

} // namespace keyhole
