#include "mpi/heartbeat.h"

#include "cli/process_group.h"
#include "core/error.h"
#include "mpi/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

namespace keyhole {
namespace {

enum Tag : int { kAsk, kNumber, kNoMore, kAlive, kGone, kLost };

constexpr int kHost = 64; // characters of a host's name that are kept
constexpr std::int64_t kNone = -1;
constexpr const char* kOtherLost = "rank 0 has lost another process";

/// Seconds since the last call, as far as this process was awake: one that was suspended, with the others or alone,
/// must not take them for lost.
class AwakeClock {
  public:
    double step() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - last_).count();
        last_ = now;
        return std::min(seconds, 0.5);
    }

  private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

double read_patience() {
    const char* text = std::getenv("KEYHOLE_MPI_PATIENCE");
    if (text == nullptr) return 60;
    char* end = nullptr;
    const double seconds = std::strtod(text, &end);
    if (end == text || *end != '\0' || !(seconds >= 1 && seconds <= 1e9))
        throw InputError(fmt::format("KEYHOLE_MPI_PATIENCE: found '{}', expected 1 second or more", text));
    return seconds;
}

} // namespace

Heartbeat::Heartbeat() : patience_(read_patience()) {
    MPI_Comm_dup(MPI_COMM_WORLD, &comm_);
    MPI_Comm_rank(comm_, &rank_);
    MPI_Comm_size(comm_, &size_);
    char host[MPI_MAX_PROCESSOR_NAME] = {};
    int length = 0;
    MPI_Get_processor_name(host, &length);
    host[kHost - 1] = '\0';
    if (rank_ == 0) hosts_.resize(static_cast<std::size_t>(size_) * kHost);
    MPI_Gather(host, kHost, MPI_CHAR, hosts_.data(), kHost, MPI_CHAR, 0, comm_);
    if (size_ == 1) return;
    working_ = size_ - 1;
    if (rank_ == 0) {
        silence_.resize(static_cast<std::size_t>(size_));
        taking_.resize(static_cast<std::size_t>(size_), true);
        silence_[0] = -1;
    }
    thread_ = std::thread([this] { rank_ == 0 ? answer() : ask(); });
}

Heartbeat::~Heartbeat() {
    stop_taking();
    leaving_ = true;
    if (thread_.joinable()) thread_.join();
}

void Heartbeat::take_message(const MPI_Status& status) {
    const int from = status.MPI_SOURCE;
    const auto r = static_cast<std::size_t>(from);
    take_signal(comm_, from, status.MPI_TAG);
    if (silence_[r] < 0) return; // was taken for lost
    silence_[r] = 0;
    if (status.MPI_TAG == kAlive) send_signal(comm_, from, lost() ? kLost : kAlive);
    if (status.MPI_TAG == kAsk) {
        const std::int64_t number = lost() ? kNone : next_++;
        MPI_Send(&number, 1, MPI_INT64_T, from, kNumber, comm_);
    }
    if (status.MPI_TAG == kNoMore) {
        taking_[r] = false;
        --working_;
    }
    if (status.MPI_TAG == kGone) silence_[r] = -1;
}

void Heartbeat::answer() {
    AwakeClock clock;
    double since_look = 0;
    for (int present = size_ - 1; present > 0; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
        while (const auto status = look_for(comm_, MPI_ANY_SOURCE, MPI_ANY_TAG)) take_message(*status);
        since_look += clock.step();
        if (since_look < 0.1) continue;
        present = 0;
        for (std::size_t r = 1; r < silence_.size(); ++r) {
            if (silence_[r] < 0) continue;
            ++present;
            silence_[r] += since_look;
            if (silence_[r] < patience_) continue;
            silence_[r] = -1;
            lost_ = static_cast<int>(r);
            if (taking_[r]) --working_;
        }
        since_look = 0;
    }
}

void Heartbeat::ask() {
    AwakeClock clock;
    const double pause = std::min(patience_ / 8, 5.0);
    bool asked = false;
    for (double since = 0; asked || !leaving_; std::this_thread::sleep_for(std::chrono::milliseconds(50))) {
        since += clock.step();
        if (asked && look_for(comm_, 0, kAlive)) {
            take_signal(comm_, 0, kAlive);
            asked = false;
        } else if (asked && look_for(comm_, 0, kLost)) {
            take_signal(comm_, 0, kLost);
            asked = false;
            others_lost_ = true;
        } else if (!asked && since >= pause) {
            send_signal(comm_, 0, kAlive);
            asked = true;
            since = 0;
        } else if (asked && since >= patience_) {
            lost_ = 0;
            return;
        }
    }
    send_signal(comm_, 0, kGone);
}

std::int64_t Heartbeat::take_number() {
    if (rank_ == 0) {
        check();
        return next_++;
    }
    send_signal(comm_, 0, kAsk);
    wait_for(comm_, 0, kNumber, [this] { check(); });
    std::int64_t number = kNone;
    MPI_Recv(&number, 1, MPI_INT64_T, 0, kNumber, comm_, MPI_STATUS_IGNORE);
    if (number == kNone) throw ProcessLost(kOtherLost);
    return number;
}

void Heartbeat::stop_taking() {
    if (rank_ > 0 && !stopped_) send_signal(comm_, 0, kNoMore);
    stopped_ = true;
}

void Heartbeat::check() const {
    if (!lost()) return;
    const char* host = rank_ == 0 ? hosts_.data() + static_cast<std::size_t>(lost_) * kHost : "";
    throw ProcessLost(fmt::format("rank {} has heard nothing of rank {}{}{} for {} s", rank_, lost_.load(),
                                  *host != '\0' ? " on " : "", host, patience_));
}

void Heartbeat::check_all() const {
    check();
    if (others_lost_) throw ProcessLost(kOtherLost);
}

} // namespace keyhole
