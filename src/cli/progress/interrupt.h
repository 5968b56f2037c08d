// Ctrl-C.
#pragma once

#include "core/progress.h"

namespace keyhole {

/// While it lives, SIGINT and SIGTERM ask `stop` to stop; a second signal ends the process at once with exit code 130.
/// One at a time.
class InterruptHandler {
  public:
    explicit InterruptHandler(StopToken& stop);
    ~InterruptHandler();
    InterruptHandler(const InterruptHandler&) = delete;
    InterruptHandler& operator=(const InterruptHandler&) = delete;
};

} // namespace keyhole
