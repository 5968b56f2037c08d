// What a long computation tells the outside, and how the outside stops it.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <ctime>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace keyhole {

/// A process has died, or can't be reached any more. The command line exits with 1.
class ProcessLost : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What one process knows of the others that do the same pass: all go through the same stages and call exchange() at
/// the same places. Each has all results in the end.
class Communicator {
  public:
    virtual ~Communicator() = default;

    virtual int rank() const = 0;
    virtual int size() const = 0;

    /// The parts of all processes, by rank. `stop`: this one has been asked to stop. @throws ProcessLost
    virtual std::vector<std::vector<char>> exchange(std::vector<char> part, bool stop) = 0;
    /// Whether one of them had been asked to stop when exchange() was last called: the same for all, so that all end at
    /// the same place.
    virtual bool stopped() const = 0;
};

/// CPU time that all threads of this process have used so far [s].
inline double cpu_seconds() noexcept {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Asks running stages to finish early and leave a valid result. Thread-safe; `request()` is signal-safe.
class StopToken {
  public:
    using Clock = std::chrono::steady_clock;

    void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
    void set_deadline(Clock::time_point t) { deadline_ = t; }
    /// Ends when the process has used so much CPU time [s], of all threads, since it began.
    void set_cpu_limit(double seconds) { cpu_limit_ = seconds; }

    /// True once somebody called request().
    bool requested() const noexcept { return requested_.load(std::memory_order_relaxed); }
    /// True once requested, past the deadline, or over the limit.
    bool stopped() const noexcept {
        return requested() || Clock::now() >= deadline_ || (cpu_limit_ < kNoLimit && cpu_seconds() >= cpu_limit_);
    }
    /// What is left until the deadline, or, where there is one, of the CPU time [s]; infinite without either.
    double seconds_left() const noexcept {
        if (cpu_limit_ < kNoLimit) return std::max(0.0, cpu_limit_ - cpu_seconds());
        if (deadline_ == Clock::time_point::max()) return kNoLimit;
        return std::max(0.0, std::chrono::duration<double>(deadline_ - Clock::now()).count());
    }

  private:
    static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

    std::atomic<bool> requested_{false};
    Clock::time_point deadline_ = Clock::time_point::max();
    double cpu_limit_ = kNoLimit;
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
    double reserve = 0;           ///< of the time until `stop`, what is left to later stages [s]
    bool whole_round = false;     ///< every pixel gets its first sample even if time is up
    bool in_overtime = false;     ///< goes on when time is up, until somebody asks for a stop
    bool by_time = false;         ///< stages may do more or less than the settings say, for the sake of others
    /// Gather rays that a record of the irradiance cache is worth for each pixel across that it serves.
    double rays_for_pixel = std::numeric_limits<double>::infinity();
    Communicator* communicator = nullptr; ///< that does this together: its user throws ProcessLost; null: alone

    /// Whether to finish early: where there is a process group, by what it has agreed on.
    bool stopped() const { return communicator != nullptr ? communicator->stopped() : asked_to_stop(); }
    /// Whether this process is to.
    bool asked_to_stop() const {
        if (stop == nullptr) return false;
        if (in_overtime) return stop->requested();
        return stop->stopped() || (reserve > 0 && stop->seconds_left() < reserve);
    }
    /// Of the time, as StopToken says; infinite where nothing stops this.
    double seconds_left() const {
        return stop != nullptr ? stop->seconds_left() : std::numeric_limits<double>::infinity();
    }
    /// With so much of the time that is left for this in reserve besides.
    RunContext with_reserve(double share) const {
        RunContext c = *this;
        const double left = seconds_left() - reserve;
        if (std::isfinite(left)) c.reserve += share * std::max(0.0, left);
        return c;
    }
    /// For what each process does by itself.
    RunContext alone() const {
        RunContext c = *this;
        c.communicator = nullptr;
        return c;
    }
    /// For the first round of samples.
    RunContext first_round() const {
        RunContext c = *this;
        c.in_overtime = whole_round;
        return c;
    }
    void advance(std::integral auto units) const {
        if (progress != nullptr) progress->advance(static_cast<std::uint64_t>(units));
    }
};

/// A stage that `context` is told of until the end of its scope, however that is left.
class ProgressStage {
  public:
    ProgressStage(const RunContext& context, std::string_view name, std::integral auto total, std::string_view unit)
        : progress_(context.progress) {
        if (progress_ != nullptr) progress_->begin(name, static_cast<std::uint64_t>(total), unit);
    }
    ~ProgressStage() {
        if (progress_ != nullptr) progress_->end();
    }
    ProgressStage(const ProgressStage&) = delete;
    ProgressStage& operator=(const ProgressStage&) = delete;

  private:
    Progress* progress_;
};

} // namespace keyhole
