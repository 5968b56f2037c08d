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
    /// Name, CPU seconds; only what comes before trials: too slow to tell. With a time trials are among them.
    std::vector<std::pair<std::string, double>> stages;
    std::uint64_t photon_bytes = 0; ///< at most, for photons, their index and importance maps
    std::vector<std::string> remarks;

    double cpu_seconds() const;
};

/// Expects the passes that the settings name, one if they name none. With a time [s of CPU] settings follow from it,
/// but for those in `given`, as in render_in_time(). Learns of direct light, looks for openings and makes trials as a
/// render does, so that both choose alike; of a time of more than a minute no more than in one of a minute. The scene's
/// window margin has to be set. @throws InputError as render().
ExpectedCost expect_cost(Scene& scene, const Settings& settings, const UserPathFile& user_paths,
                         const Findings& findings, std::optional<double> time = std::nullopt,
                         const std::set<std::string>& given = {});

} // namespace keyhole
