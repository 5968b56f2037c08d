// CPU time.
#pragma once

#include <ctime>

namespace keyhole {

/// CPU time that all threads of this process have used so far [s].
inline double cpu_seconds() noexcept {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

} // namespace keyhole
