// What a long computation tells the outside, and how the outside stops it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string_view>

namespace keyhole {

/// Asks running stages to finish early and leave a valid result. Thread-safe; `request()` is signal-safe.
class StopToken {
  public:
    using Clock = std::chrono::steady_clock;

    void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
    void set_deadline(Clock::time_point t) { deadline_ = t; }

    /// True once somebody called request().
    bool requested() const noexcept { return requested_.load(std::memory_order_relaxed); }
    /// True once requested or past the deadline.
    bool stopped() const noexcept { return requested() || Clock::now() >= deadline_; }

  private:
    std::atomic<bool> requested_{false};
    Clock::time_point deadline_ = Clock::time_point::max();
};

/// Receives the progress of each stage. Calls to advance() come from many threads at once.
class Progress {
  public:
    virtual ~Progress() = default;
    /// A stage of `total` units (for example "pixels") begins; the one before it has ended.
    virtual void begin(std::string_view stage, std::uint64_t total, std::string_view unit) = 0;
    virtual void advance(std::uint64_t units) = 0;
    virtual void end() = 0;
};

/// What a stage needs from its caller besides its input.
struct RunContext {
    StopToken* stop = nullptr;    ///< may be null: never stopped
    Progress* progress = nullptr; ///< may be null: silent

    bool stopped() const { return stop != nullptr && stop->stopped(); }
    void begin(std::string_view stage, std::uint64_t total, std::string_view unit) const {
        if (progress != nullptr) progress->begin(stage, total, unit);
    }
    void advance(std::uint64_t units) const {
        if (progress != nullptr) progress->advance(units);
    }
    void end() const {
        if (progress != nullptr) progress->end();
    }
};

} // namespace keyhole
