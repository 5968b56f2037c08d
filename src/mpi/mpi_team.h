// A team over MPI.
#pragma once

#include "cli/team.h"
#include "mpi/pulse.h"

namespace keyhole {

/// All processes of MPI_COMM_WORLD. Rank 0 hands out numbers; films come together in a binary tree.
///
/// Not thread-safe: one thread calls at a time.
class MpiTeam final : public Team {
  public:
    int rank() const override { return pulse_.rank(); }
    /// Whether this process has lost touch with rank 0.
    bool is_cut_off() const { return rank() > 0 && pulse_.lost(); }
    std::optional<std::int64_t> take_number() override;
    void wait_for_all() override;
    Picture collect(Picture part, const std::function<Picture(Picture, Picture)>& join) override;

  private:
    void wait_until_all_are_done();

    Pulse pulse_;
};

} // namespace keyhole
