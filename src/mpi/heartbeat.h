// Signs of life between the processes of a group.
#pragma once

#include <atomic>
#include <cstdint>
#include <mpi.h>
#include <string>
#include <thread>
#include <vector>

namespace keyhole {

/// A thread of each process. Those of ranks above 0 ask rank 0 for a sign of life every now and then; that of rank 0
/// answers, hands out numbers, and knows who still works. MPI doesn't notice a cable that is pulled for a quarter of an
/// hour or more: a process that hears nothing for KEYHOLE_MPI_PATIENCE seconds (60) takes the other side for lost.
class Heartbeat {
  public:
    /// MPI must be initialised, with MPI_THREAD_MULTIPLE. All processes construct theirs at the same time.
    Heartbeat();
    ~Heartbeat(); ///< waits until all that are not lost have got here
    Heartbeat(const Heartbeat&) = delete;
    Heartbeat& operator=(const Heartbeat&) = delete;

    int rank() const { return rank_; }
    int size() const { return size_; }

    /// The next number; of a rank above 0, asks for it.
    std::int64_t take_number();
    /// This process takes no more numbers.
    void stop_taking();
    /// Of rank 0: whether another process may still take some.
    bool others_work() const { return working_ > 0; }

    /// Whether somebody is lost: of ranks above 0, rank 0.
    bool lost() const { return lost_ >= 0; }
    /// @throws ProcessLost if somebody is.
    void check() const;
    /// The same, on every rank, once rank 0 has lost anyone: for what needs all processes. @throws ProcessLost
    void check_all() const;

  private:
    void answer();
    void ask();
    void take_message(const MPI_Status& status);

    int rank_ = 0, size_ = 1;
    double patience_ = 60; ///< [s]
    MPI_Comm comm_ = MPI_COMM_NULL;
    std::vector<char> hosts_;     // of rank 0: of each process, kHost characters
    std::vector<double> silence_; // of rank 0: seconds that nothing was heard of each; negative: gone
    std::vector<bool> taking_;    // of rank 0: who may still ask for numbers
    std::atomic<std::int64_t> next_{0};
    std::atomic<int> working_{0}, lost_{-1};
    std::atomic<bool> leaving_{false}, others_lost_{false};
    bool stopped_ = false;
    std::thread thread_;
};

} // namespace keyhole
