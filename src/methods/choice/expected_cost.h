// What a render will cost, from short trials.
#pragma once

#include "methods/findings.h"
#include "methods/render.h"

namespace keyhole {

struct ExpectedCost {
    std::string method;                                 ///< the setting's, or what `auto` stands for
    std::vector<std::pair<std::string, double>> stages; ///< name, CPU seconds; empty: too slow to tell
    std::uint64_t photon_bytes = 0;                     ///< at most, for photons, their index and importance maps
    std::vector<std::string> remarks;

    double cpu_seconds() const;
};

/// Expects the passes that the settings name, one if they name none. Takes about a second of CPU time, whatever the
/// scene. The scene's window margin has to be set. @throws as render().
ExpectedCost expect_cost(Scene& scene, const Settings& settings, const UserPathFile& user_paths, Findings& findings);

} // namespace keyhole
