// Ctrl-C.
#pragma once

#include "core/progress.h"

#include <csignal>

namespace keyhole {

/// While it lives, SIGINT and SIGTERM ask `stop` to stop; a second signal ends the process at once with exit code 130.
/// After that they do what they did before. One at a time.
class InterruptHandler {
  public:
    explicit InterruptHandler(StopToken& stop);
    ~InterruptHandler();
    InterruptHandler(const InterruptHandler&) = delete;
    InterruptHandler& operator=(const InterruptHandler&) = delete;

  private:
    struct sigaction before_int_, before_term_;
};

} // namespace keyhole
