#include "cli/standard_streams.h"

#include <csignal>
#include <fcntl.h>
#include <unistd.h>

namespace keyhole {

void secure_standard_streams() {
    // The lowest number that is free is taken: all up to that of stderr, once they are open.
    int opened = 0;
    do opened = open("/dev/null", O_RDWR);
    while (opened >= 0 && opened <= STDERR_FILENO);
    if (opened > STDERR_FILENO) close(opened);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

} // namespace keyhole
