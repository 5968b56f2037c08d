// The picture so far: on SIGHUP as files, and all the while in a viewer.
#pragma once

#include "film/picture.h"
#include "session/work_partition.h"

#include <chrono>
#include <functional>
#include <memory>
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

/// While it lives, SIGHUP asks for a picture. One at a time.
class LiveView {
  public:
    /// @param address HOST:PORT of a viewer; empty: none. @throws InputError as DisplayServer.
    /// @param name of the picture there.
    /// @param write called with the picture so far after a SIGHUP.
    LiveView(const std::string& address, std::string name, std::function<void(const Picture&)> write);
    ~LiveView();
    LiveView(const LiveView&) = delete;
    LiveView& operator=(const LiveView&) = delete;

    /// Has the render show its pictures; the view must outlive it.
    void watch(WorkPartition& share);
    /// Shows the last picture.
    void show(const Picture& picture);

  private:
    bool wants_look() const;
    void look(const Picture& picture);

    std::unique_ptr<DisplayServer> server_;
    std::string name_;
    std::function<void(const Picture&)> write_;
    std::chrono::steady_clock::time_point shown_{};
};

} // namespace keyhole
