#include "cli/progress/interrupt.h"

#include "cli/program.h"
#include "film/files/atomic_file.h"

#include <atomic>
#include <csignal>
#include <unistd.h>

namespace keyhole {
namespace {

std::atomic<StopToken*> handled{nullptr};
static_assert(std::atomic<StopToken*>::is_always_lock_free, "signal handlers may not wait for locks");

extern "C" void on_signal(int /*signal*/) {
    StopToken* stop = handled.load();
    if (stop == nullptr || stop->requested()) {
        remove_unfinished_file();
        _exit(kInterrupted);
    }
    stop->request();
}

} // namespace

InterruptHandler::InterruptHandler(StopToken& stop) {
    handled = &stop;
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, &before_int_);
    sigaction(SIGTERM, &action, &before_term_);
}

InterruptHandler::~InterruptHandler() {
    sigaction(SIGINT, &before_int_, nullptr);
    sigaction(SIGTERM, &before_term_, nullptr);
    handled = nullptr;
}

} // namespace keyhole
