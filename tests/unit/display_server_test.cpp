// tev's protocol, read back byte by byte by a server that stands in for it.
#include "cli/progress/live_view.h"
#include "core/error.h"

#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <array>
#include <cstring>
#include <future>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

using namespace keyhole;

namespace {

/// Listens on a port of its own and keeps all that one client sends.
class FakeViewer {
  public:
    FakeViewer() : listener_(socket(AF_INET, SOCK_STREAM, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), size), 0);
        EXPECT_EQ(listen(listener_, 1), 0);
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
        received_ = std::async(std::launch::async, [this] {
            std::string all;
            const int client = accept(listener_, nullptr, nullptr);
            std::array<char, 4096> part;
            for (ssize_t n; (n = recv(client, part.data(), part.size(), 0)) > 0;)
                all.append(part.data(), static_cast<std::size_t>(n));
            close(client);
            return all;
        });
    }
    ~FakeViewer() { close(listener_); }

    std::string address() const { return "127.0.0.1:" + std::to_string(port_); }
    std::string received() { return received_.get(); }

  private:
    int listener_;
    int port_ = 0;
    std::future<std::string> received_;
};

/// Reads packets as tev does.
struct Reader {
    std::string bytes;
    std::size_t at = 0;

    template <class T> T number() {
        T value;
        EXPECT_LE(at + sizeof(T), bytes.size());
        std::memcpy(&value, bytes.data() + at, sizeof(T));
        at += sizeof(T);
        return value;
    }
    std::string text() {
        const std::string found = bytes.c_str() + at;
        at += found.size() + 1;
        return found;
    }
    void expect_colours() {
        EXPECT_EQ(number<std::int32_t>(), 3);
        for (const char* name : {"R", "G", "B"}) EXPECT_EQ(text(), name);
    }
};

} // namespace

TEST(DisplayServer, SendsAnImageAndThenItsUpdates) {
    FakeViewer viewer;
    Image image(5, 2, 3);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i) / 4;
    {
        DisplayServer server(viewer.address());
        EXPECT_TRUE(server.show("picture", image));
        EXPECT_TRUE(server.show("picture", image));
    }
    Reader r{viewer.received()};
    std::size_t begin = r.at;
    std::uint32_t length = r.number<std::uint32_t>();
    EXPECT_EQ(r.number<std::uint8_t>(), 4); // create
    EXPECT_EQ(r.number<std::uint8_t>(), 1); // grab the focus
    EXPECT_EQ(r.text(), "picture");
    EXPECT_EQ(r.number<std::int32_t>(), 5);
    EXPECT_EQ(r.number<std::int32_t>(), 2);
    r.expect_colours();
    EXPECT_EQ(r.at - begin, length);
    for (int update = 0; update < 2; ++update) {
        begin = r.at;
        length = r.number<std::uint32_t>();
        EXPECT_EQ(r.number<std::uint8_t>(), 6); // update
        EXPECT_EQ(r.number<std::uint8_t>(), 0);
        EXPECT_EQ(r.text(), "picture");
        r.expect_colours();
        for (const std::int32_t bound : {0, 0, 5, 2}) EXPECT_EQ(r.number<std::int32_t>(), bound);
        for (const std::int64_t offset : {0, 1, 2}) EXPECT_EQ(r.number<std::int64_t>(), offset);
        for (int channel = 0; channel < 3; ++channel) EXPECT_EQ(r.number<std::int64_t>(), 3);
        for (const float value : image.data) EXPECT_EQ(r.number<float>(), value);
        EXPECT_EQ(r.at - begin, length);
    }
    EXPECT_EQ(r.at, r.bytes.size());
}

TEST(DisplayServer, RefusesAddressesThatLeadNowhere) {
    for (const char* address : {"", "localhost", ":1", "localhost:", "127.0.0.1:1"})
        EXPECT_THROW(DisplayServer{address}, InputError) << address;
}

TEST(DisplayServer, AViewerThatGoesAwayEndsNothing) {
    const int listener = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
    ASSERT_EQ(listen(listener, 1), 0);
    getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
    DisplayServer server("127.0.0.1:" + std::to_string(ntohs(address.sin_port)));
    close(accept(listener, nullptr, nullptr));
    close(listener);
    const Image image(400, 400, 3);
    bool sent = true;
    for (int i = 0; i < 100 && sent; ++i) sent = server.show("picture", image);
    EXPECT_FALSE(sent);
    EXPECT_FALSE(server.show("picture", image));
}
