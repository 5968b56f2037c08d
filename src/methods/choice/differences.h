// Settings in words.
#pragma once

#include "core/settings.h"

#include <string>

namespace keyhole {

/// " key=value" for each setting of `b` that `a` has otherwise, but for the seed: of several renders that fill a time
/// each has one that follows from that of `a`.
std::string differences(const Settings& a, Settings b);

} // namespace keyhole
