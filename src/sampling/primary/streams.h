// Random streams of primary sample space.
#pragma once

#include "core/rng.h"

namespace keyhole {

constexpr StreamPurpose kPrimaryStart{101}, kPrimaryChain{102}, kFailureStudy{103}, kBidirectional{104};

} // namespace keyhole
