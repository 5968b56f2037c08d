// A team over MPI.
#pragma once

#include "cli/team.h"

#include <atomic>
#include <thread>

namespace keyhole {

/// All processes of MPI_COMM_WORLD. Numbers are handed out by a thread of rank 0. Waiting sleeps in between, since MPI
/// itself waits by asking again and again, on cores that others need.
///
/// Not thread-safe: one thread calls at a time. MPI itself has to be (MPI_THREAD_MULTIPLE).
class MpiTeam final : public Team {
  public:
    /// MPI must be initialised.
    MpiTeam();
    ~MpiTeam() override;
    MpiTeam(const MpiTeam&) = delete;
    MpiTeam& operator=(const MpiTeam&) = delete;

    int rank() const override { return rank_; }
    std::int64_t take_number() override;
    void wait_for_all() override;
    void collect(const Picture& part, const std::function<void(Picture)>& join) override;

  private:
    void hand_out();
    void finish();

    int rank_ = 0, size_ = 1;
    std::atomic<std::int64_t> next_{0}; // of rank 0
    std::thread counter_;               // likewise
    bool is_finished_ = false;          // of the others: takes no more numbers
};

} // namespace keyhole
