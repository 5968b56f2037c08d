// The picture so far: on SIGHUP as files, and all the while in a viewer.
#pragma once

#include "cli/progress/display_server.h"
#include "film/picture.h"
#include "session/work_partition.h"

#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace keyhole {

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
