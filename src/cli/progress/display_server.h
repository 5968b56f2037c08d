// Live view: pictures sent to a program that speaks tev's protocol.
#pragma once

#include "film/picture.h"

#include <cstdint>
#include <string>
#include <vector>

namespace keyhole {

/// A connection to tev (https://github.com/Tom94/tev), or to what listens like it, by TCP. A packet is its length as 4
/// bytes, itself included, a byte for its kind and what the kind holds; numbers are little-endian, strings end in 0.
/// Not thread-safe.
class DisplayServer {
  public:
    /// Connects to "HOST:PORT". @throws InputError if the text isn't that, or nobody listens there.
    explicit DisplayServer(const std::string& address);
    ~DisplayServer();
    DisplayServer(const DisplayServer&) = delete;
    DisplayServer& operator=(const DisplayServer&) = delete;

    /// Shows an image of 3 channels under `name`; the first one makes it known. Returns whether it went through; once
    /// it did not, nothing more is sent, for a viewer that was closed is no reason to end a render.
    bool show(const std::string& name, const Image& image);

  private:
    bool send_packet(std::vector<char> content);

    int socket_ = -1;
    std::string shown_; // name and size that the viewer knows
};

} // namespace keyhole
