// Means of pictures.
#pragma once

#include "film/picture.h"

namespace keyhole {

/// Every layer of `picture` becomes (1 - weight) times itself plus `weight` times that of `other`, which has it in the
/// same size; layers that only `other` has are ignored.
/// @throws InputError that names a layer which `other` lacks.
void blend(Picture& picture, const Picture& other, double weight);

} // namespace keyhole
