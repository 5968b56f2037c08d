// Media that people have measured.
#pragma once

#include "core/vec.h"

#include <map>
#include <string_view>

namespace keyhole {

/// How a medium scatters and absorbs [1/mm], for the three primaries.
struct MeasuredMedium {
    Rgb reduced_scattering; ///< (1 - g) sigma_s
    Rgb absorption;         ///< sigma_a
};

/// By the names that pbrt's files have for them: those of Jensen et al. 2001, "A Practical Model for Subsurface Light
/// Transport", and of Narasimhan et al. 2006, "Acquiring Scattering Properties of Participating Media by Dilution".
const std::map<std::string_view, MeasuredMedium>& measured_media();

} // namespace keyhole
