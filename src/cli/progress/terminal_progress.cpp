#include "cli/progress/terminal_progress.h"

#include "cli/words/tell.h"
#include "cli/words/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>
#include <sys/ioctl.h>
#include <unistd.h>

namespace keyhole {
namespace {

using namespace std::chrono_literals;

double seconds_between(TerminalProgress::Clock::time_point a, TerminalProgress::Clock::time_point b) {
    return std::chrono::duration<double>(b - a).count();
}

constexpr const char* kEraseLine = "\r\033[K";

} // namespace

TerminalProgress::TerminalProgress(std::FILE* out, bool terminal, int columns, std::function<Clock::time_point()> now,
                                   std::function<double()> time_left)
    : out_(out), terminal_(terminal), columns_(static_cast<std::size_t>(std::max(columns, 20))), now_(std::move(now)),
      time_left_(std::move(time_left)) {}

double TerminalProgress::time_left() const {
    return time_left_ ? time_left_() : std::numeric_limits<double>::infinity();
}

void TerminalProgress::begin(std::string_view stage, std::uint64_t total, std::string_view unit) {
    const std::lock_guard lock(mutex_);
    stage_ = stage;
    unit_ = unit;
    total_ = total;
    done_ = 0;
    drawn_done_ = 0;
    drawn_share_ = 0;
    start_ = drawn_ = now_();
    time_left_at_start_ = time_left();
    if (terminal_) draw(start_, 0);
}

bool TerminalProgress::due(Clock::time_point now, std::uint64_t done) const {
    if (terminal_) return now - drawn_ >= 100ms;
    if (now - drawn_ < 1s) return false;
    // The first line comes early: it says what runs, and how long it will take.
    const bool first = drawn_done_ == 0 && done > 0;
    return first || now - drawn_ >= 10s || share_of(done) - drawn_share_ >= 0.1;
}

void TerminalProgress::advance(std::uint64_t units) {
    done_ += units;
    // A thread that would have to wait leaves the drawing to the one that draws.
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    const std::uint64_t done = done_;
    if (const auto now = now_(); due(now, done)) draw(now, done);
}

void TerminalProgress::end() {
    const std::lock_guard lock(mutex_);
    const double seconds = seconds_between(start_, now_());
    const auto done = static_cast<double>(done_);
    tell_to(out_, "{}{}: {}{} in {}", terminal_ ? kEraseLine : "", stage_, with_prefix(done), unit_, duration(seconds));
    if (seconds > 0) tell_to(out_, ", {}{}/s", with_prefix(done / seconds), unit_);
    tell_to(out_, "\n");
    std::fflush(out_);
}

void TerminalProgress::draw(Clock::time_point now, std::uint64_t done) {
    drawn_ = now;
    drawn_done_ = done;
    drawn_share_ = share_of(done);
    const std::string text = line(seconds_between(start_, now), done);
    if (terminal_) {
        // One column short, because some terminals wrap when the last one is filled.
        tell_to(out_, "{}{}", kEraseLine, text.substr(0, columns_ - 1));
    } else {
        tell_to(out_, "{}\n", text);
    }
    std::fflush(out_);
}

double TerminalProgress::share_of(std::uint64_t done) const {
    const double work = total_ == 0 ? 0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
    const bool ends_by_time = std::isfinite(time_left_at_start_) && time_left_at_start_ > 0;
    return ends_by_time ? std::max(work, 1 - time_left() / time_left_at_start_) : work;
}

std::string TerminalProgress::line(double seconds, std::uint64_t done) const {
    const double share = share_of(done);
    const bool has_end = total_ > 0 || share > 0;
    std::string text = stage_;
    if (terminal_ && has_end) {
        constexpr std::size_t kBar = 24;
        const auto filled = static_cast<std::size_t>(share * static_cast<double>(kBar));
        text += " [" + std::string(filled, '#') + std::string(kBar - filled, '.') + "]";
    } else {
        text += ":";
    }
    text += has_end ? fmt::format(" {:3.0f} %", std::floor(100 * share))
                    : fmt::format(" {}{}", with_prefix(static_cast<double>(done)), unit_);
    if (done > 0 && seconds > 0) {
        text += fmt::format("  {}{}/s", with_prefix(static_cast<double>(done) / seconds), unit_);
        if (has_end) text += fmt::format("  {} left", duration(seconds * (1 - share) / share));
    }
    return text;
}

std::unique_ptr<TerminalProgress> progress_on_stderr(const StopToken& stop) {
    const char* term = std::getenv("TERM");
    const bool terminal = isatty(STDERR_FILENO) != 0 && term != nullptr && std::string_view(term) != "dumb";
    winsize size{};
    const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return std::make_unique<TerminalProgress>(stderr, terminal, known ? size.ws_col : 80, &TerminalProgress::Clock::now,
                                              [&stop] { return stop.seconds_left(); });
}

} // namespace keyhole
