// What a render tells about itself.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace keyhole {

struct StageStats {
    std::string name;
    double wall_seconds = 0, cpu_seconds = 0; ///< CPU time of all threads
    std::uint64_t rays = 0;
};

/// The ledger of one kind of proposal: proposed = failed + zero + nan + rejected + accepted.
struct ProposalStats {
    std::string name;
    std::uint64_t proposed = 0, zero = 0, nan = 0, rejected = 0, accepted = 0;
    std::map<std::string, std::uint64_t> failed; ///< by reason
    double seconds = 0;
    double deposited = 0; ///< share of all deposits that were left by states of its making
};

struct RenderStats {
    std::string method; ///< the setting's, or what `auto` stood for
    std::vector<StageStats> stages;
    double samples = 0; ///< of a pixel, or mutations by pixel of methods that only run chains; of whole units of work
    double brightness = 0, brightness_error = 0; ///< B_eye and its standard error [W/(m^2 sr)]
    std::vector<ProposalStats> proposals;
    std::uint64_t photons_global = 0, photons_caustic = 0, photon_bytes = 0, importons = 0, importon_bytes = 0;
    std::map<std::string, double> values; ///< further figures, by name
    std::vector<std::string> remarks;     ///< choices that were made, in words
    std::vector<std::string> warnings;    ///< in words
    bool complete = true;                 ///< false after a stop
};

} // namespace keyhole
