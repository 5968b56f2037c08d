#include "cli/display_server.h"

#include "core/error.h"

#include <fmt/format.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace keyhole {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are sent as they are in memory");

enum class Packet : std::uint8_t { create_image = 4, update_image = 6 };

/// A packet's content, put together.
class Content {
  public:
    explicit Content(Packet kind) { add(kind); }

    template <class T> void add(const T& value) {
        const auto* const bytes = reinterpret_cast<const char*>(&value);
        bytes_.insert(bytes_.end(), bytes, bytes + sizeof(T));
    }
    void add_text(const std::string& text) {
        bytes_.insert(bytes_.end(), text.c_str(), text.c_str() + text.size() + 1);
    }
    void add_colour_names() {
        add(std::int32_t{3});
        for (const char* channel : {"R", "G", "B"}) add_text(channel);
    }
    std::vector<char>& bytes() { return bytes_; }

  private:
    std::vector<char> bytes_;
};

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
    const auto* const bytes = reinterpret_cast<const char*>(&length);
    content.insert(content.begin(), bytes, bytes + sizeof length);
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
        Content create(Packet::create_image);
        create.add(kGrabFocus);
        create.add_text(name);
        create.add(std::int32_t{image.width});
        create.add(std::int32_t{image.height});
        create.add_colour_names();
        if (!send_packet(std::move(create.bytes()))) return false;
        shown_ = known;
    }
    Content update(Packet::update_image);
    update.add(kLeaveFocus);
    update.add_text(name);
    update.add_colour_names();
    for (const std::int32_t bound : {0, 0, image.width, image.height}) update.add(bound);
    for (const std::int64_t offset : {0, 1, 2}) update.add(offset);
    for (int channel = 0; channel < 3; ++channel) update.add(std::int64_t{3}); // stride
    const auto* const pixels = reinterpret_cast<const char*>(image.data.data());
    update.bytes().insert(update.bytes().end(), pixels, pixels + image.data.size() * sizeof(float));
    return send_packet(std::move(update.bytes()));
}

} // namespace keyhole
