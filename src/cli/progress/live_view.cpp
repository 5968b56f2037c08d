#include "cli/progress/live_view.h"

#include "cli/words/tell.h"
#include "core/bytes.h"
#include "core/error.h"

#include <fmt/format.h>

#include <atomic>
#include <bit>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace keyhole {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are sent as they are in memory");

enum class Packet : std::uint8_t { create_image = 4, update_image = 6 };

/// The beginning of a packet.
ByteWriter packet(Packet kind, std::uint8_t focus, const std::string& name) {
    ByteWriter content;
    content.put(kind);
    content.put(focus);
    content.append(name.c_str(), name.size() + 1);
    return content;
}

void put_colour_names(ByteWriter& content) {
    content.put(std::int32_t{3});
    for (const char* channel : {"R", "G", "B"}) content.append(channel, 2);
}

/// A connected socket, or -1.
int connect_to(const std::string& host, const std::string& port) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) return -1;
    int result = -1;
    for (const addrinfo* a = found; a != nullptr && result < 0; a = a->ai_next) {
        const int s = socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
        if (s < 0) continue;
        const timeval patience{5, 0};
        setsockopt(s, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        if (connect(s, a->ai_addr, a->ai_addrlen) == 0)
            result = s;
        else
            close(s);
    }
    freeaddrinfo(found);
    return result;
}

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

DisplayServer::DisplayServer(const std::string& address) {
    const std::size_t colon = address.rfind(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == address.size())
        throw InputError("found --display-server '" + address + "', expected HOST:PORT such as localhost:14158");
    socket_ = connect_to(address.substr(0, colon), address.substr(colon + 1));
    if (socket_ < 0) throw InputError("nobody listens at " + address + ": expected tev, or another viewer like it");
}

DisplayServer::~DisplayServer() {
    if (socket_ >= 0) close(socket_);
}

bool DisplayServer::send_packet(std::vector<char> content) {
    const auto length = static_cast<std::uint32_t>(content.size() + sizeof(std::uint32_t));
    const auto bytes = bytes_of(&length);
    content.insert(content.begin(), bytes.begin(), bytes.end());
    for (std::size_t sent = 0; socket_ >= 0 && sent < content.size();) {
        const ssize_t n = send(socket_, content.data() + sent, content.size() - sent, MSG_NOSIGNAL);
        if (n > 0) {
            sent += static_cast<std::size_t>(n);
        } else if (errno != EINTR) {
            close(socket_);
            socket_ = -1;
        }
    }
    return socket_ >= 0;
}

bool DisplayServer::show(const std::string& name, const Image& image) {
    constexpr std::uint8_t kGrabFocus = 1, kLeaveFocus = 0;
    if (const std::string known = fmt::format("{} {}x{}", name, image.width, image.height); shown_ != known) {
        ByteWriter create = packet(Packet::create_image, kGrabFocus, name);
        create.put(std::int32_t{image.width});
        create.put(std::int32_t{image.height});
        put_colour_names(create);
        if (!send_packet(create.take())) return false;
        shown_ = known;
    }
    ByteWriter update = packet(Packet::update_image, kLeaveFocus, name);
    put_colour_names(update);
    for (const std::int32_t bound : {0, 0, image.width, image.height}) update.put(bound);
    for (const std::int64_t offset : {0, 1, 2}) update.put(offset);
    for (int channel = 0; channel < 3; ++channel) update.put(std::int64_t{3}); // stride
    update.append(image.data.data(), image.data.size());
    return send_packet(update.take());
}

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
