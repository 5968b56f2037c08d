#include "cli/progress/interrupt.h"

#include "cli/command.h"
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

void handle_signals(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

} // namespace

InterruptHandler::InterruptHandler(StopToken& stop) {
    handled = &stop;
    handle_signals(on_signal);
}

InterruptHandler::~InterruptHandler() {
    handle_signals(SIG_DFL);
    handled = nullptr;
}

} // namespace keyhole
