#include "cli/progress/live_view.h"

#include "cli/words/tell.h"
#include "core/error.h"

#include <fmt/format.h>

#include <atomic>
#include <csignal>

namespace keyhole {
namespace {

std::atomic<bool> asked{false};
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers may not wait for locks");

extern "C" void on_hangup(int /*signal*/) { asked = true; }

void handle_hangup(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigaction(SIGHUP, &action, nullptr);
}

/// Between two pictures for a viewer.
constexpr std::chrono::seconds kPause{1};

} // namespace

LiveView::LiveView(const std::string& address, std::string name, std::function<void(const Picture&)> write)
    : server_(address.empty() ? nullptr : std::make_unique<DisplayServer>(address)), name_(std::move(name)),
      write_(std::move(write)) {
    asked = false;
    handle_hangup(on_hangup);
}

LiveView::~LiveView() { handle_hangup(SIG_DFL); }

void LiveView::watch(WorkPartition& share) {
    share.wants_look = [this] { return wants_look(); };
    share.look = [this](const Picture& picture) { look(picture); };
}

bool LiveView::wants_look() const {
    return asked || (server_ != nullptr && std::chrono::steady_clock::now() >= shown_ + kPause);
}

void LiveView::look(const Picture& picture) {
    if (asked.exchange(false)) {
        try {
            write_(picture);
        } catch (const InputError& e) {
            // A full disk is no reason to lose the render as well: there may be room again.
            tell("keyhole: warning: no picture so far: {}\n", e.what());
        }
    }
    show(picture);
}

void LiveView::show(const Picture& picture) {
    if (server_ == nullptr) return;
    if (!server_->show(name_, picture.layers.at("beauty"))) {
        tell("keyhole: the viewer has gone; nothing more is sent to it\n");
        server_.reset();
    }
    shown_ = std::chrono::steady_clock::now();
}

} // namespace keyhole
