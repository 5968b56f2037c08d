// What a render will cost, from one that does a sixteenth of everything.
#pragma once

#include "render/render.h"

namespace keyhole {

struct ExpectedCost {
    std::string method;                                 ///< the setting's, or what `auto` stands for
    std::vector<std::pair<std::string, double>> stages; ///< name, CPU seconds
    std::uint64_t photon_bytes = 0;                     ///< at most, for photons, their index and importance maps
    std::vector<std::string> remarks;

    double cpu_seconds() const;
};

/// Takes about a sixteenth of the render's time. Expects the passes that the settings name, one if they name none.
/// @throws as render().
ExpectedCost expect_cost(Scene& scene, const Settings& settings, const RunContext& context,
                         const UserPathFile& user_paths = {});

} // namespace keyhole
