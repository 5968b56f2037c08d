// Programs run as processes of their own: their CPU time and memory are their own, and so are their crashes.
#pragma once

#include "core/progress.h"

#include <cstdint>
#include <string>
#include <vector>

namespace keyhole {

struct ProcessResult {
    int exit_code = -1;     ///< -1: ended by a signal
    double cpu_seconds = 0; ///< user and system
    double wall_seconds = 0;
    std::int64_t peak_bytes = 0; ///< of resident memory
    std::string message;         ///< last line of what it wrote to stderr
};

/// This very program.
constexpr const char* kSelf = "/proc/self/exe";

/// Runs a program, looked for as a shell does, and waits for its end; kills it once `stop` is requested. Thread-safe.
/// @param log receives what it writes; replaced.
/// @throws std::system_error if it can't be started.
ProcessResult run_process(const std::string& program, const std::vector<std::string>& arguments, const std::string& log,
                          const StopToken& stop);

} // namespace keyhole
