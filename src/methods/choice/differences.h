// Settings in words.
#pragma once

#include "core/settings.h"

#include <string>

namespace keyhole {

/// " key=value" for each setting of `b` that `a` has otherwise.
std::string differences(const Settings& a, const Settings& b);

} // namespace keyhole
