// A process group over MPI.
#pragma once

#include "cli/process_group.h"
#include "mpi/heartbeat.h"

namespace keyhole {

/// All processes of MPI_COMM_WORLD. Rank 0 hands out numbers; films come together in a binary tree.
///
/// Not thread-safe: one thread calls at a time.
class MpiProcessGroup final : public ProcessGroup {
  public:
    int rank() const override { return heartbeat_.rank(); }
    int size() const override { return heartbeat_.size(); }
    std::vector<std::vector<char>> exchange(std::vector<char> part, bool stop) override;
    bool stopped() const override { return stopped_; }
    /// Whether this process has lost touch with rank 0.
    bool is_cut_off() const { return rank() > 0 && heartbeat_.lost(); }
    std::optional<std::int64_t> take_number() override;
    void wait_for_all() override;
    Picture collect(Picture part, const std::function<Picture(Picture, Picture)>& join) override;

  private:
    void wait_until_all_are_done();

    Heartbeat heartbeat_;
    bool stopped_ = false;
};

} // namespace keyhole
