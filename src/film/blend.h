// Means of pictures.
#pragma once

#include "film/picture.h"

namespace keyhole {

/// Every layer of `picture` becomes (1 - weight) times itself plus `weight` times that of `other`, which has the same
/// layers of the same size.
/// @throws InputError that names a layer which isn't in both.
void blend(Picture& picture, const Picture& other, double weight);

} // namespace keyhole
