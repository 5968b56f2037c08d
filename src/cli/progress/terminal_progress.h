// Progress on a terminal, or as lines of a log.
#pragma once

#include "core/progress.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace keyhole {

/// On a terminal one line, redrawn at most ten times a second: stage, bar, percent, rate, time left. Elsewhere plain
/// lines, one after a second and one for every 10 % or 10 s, at most one a second. Where stages end by time, percent
/// and time left are those of time or of work, whichever comes first. Each stage ends in a line that stays. Thread
/// safety: advance() from any thread at any time; begin() and end() from one.
class TerminalProgress final : public Progress {
  public:
    using Clock = std::chrono::steady_clock;

    /// @param out where to write; not closed.
    /// @param terminal redraw one line instead of writing many.
    /// @param columns most columns of that line.
    /// @param now the clock, for tests.
    /// @param time_left what is left of the time that stages end by [any unit]; none: they end by their work alone.
    TerminalProgress(std::FILE* out, bool terminal, int columns = 80,
                     std::function<Clock::time_point()> now = &Clock::now, std::function<double()> time_left = {});

    void begin(std::string_view stage, std::uint64_t total, std::string_view unit) override;
    void advance(std::uint64_t units) override;
    void end() override;

  private:
    /// Whether it is time for another line.
    bool due(Clock::time_point now, std::uint64_t done) const;
    void draw(Clock::time_point now, std::uint64_t done);
    std::string line(double seconds, std::uint64_t done) const;
    double time_left() const;
    /// How much of the stage is over, by work or by time.
    double share_of(std::uint64_t done) const;

    std::FILE* out_;
    bool terminal_;
    std::size_t columns_;
    std::function<Clock::time_point()> now_;
    std::function<double()> time_left_;

    std::string stage_, unit_;
    std::uint64_t total_ = 0;
    Clock::time_point start_;
    double time_left_at_start_ = 0;
    std::atomic<std::uint64_t> done_{0};

    std::mutex mutex_; ///< guards what follows and the output
    Clock::time_point drawn_;
    std::uint64_t drawn_done_ = 0;
    double drawn_share_ = 0;
};

/// On stderr, whatever that is. Refers to `stop`.
std::unique_ptr<TerminalProgress> progress_on_stderr(const StopToken& stop);

} // namespace keyhole
