// What a render will cost, from short trials.
#pragma once

#include "methods/findings.h"
#include "methods/render.h"

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace keyhole {

struct ExpectedCost {
    std::string method; ///< the setting's, or what `auto` stands for
    /// Name, CPU seconds; empty: too slow to tell. With a time trials are among them.
    std::vector<std::pair<std::string, double>> stages;
    std::uint64_t photon_bytes = 0; ///< at most, for photons, their index and importance maps
    std::vector<std::string> remarks;

    double cpu_seconds() const;
};

/// Expects the passes that the settings name, one if they name none. With a time [s of CPU] settings follow from it,
/// but for those in `given`, as in render_in_time(). Takes about a second of CPU time, whatever the
/// scene. The scene's window margin has to be set. @throws as render().
ExpectedCost expect_cost(Scene& scene, const Settings& settings, const UserPathFile& user_paths, Findings& findings,
                         std::optional<double> time = std::nullopt, const std::set<std::string>& given = {});

} // namespace keyhole
