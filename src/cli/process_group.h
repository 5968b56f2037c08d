// Several processes that render one picture.
#pragma once

#include "core/progress.h"
#include "film/picture.h"

#include <cstdint>
#include <functional>
#include <optional>

namespace keyhole {

/// What one process knows of the others. All of them make the same calls, apart from take_number(). Rank 0 talks and
/// writes.
class ProcessGroup : public Communicator {
  public:
    /// The n-th call made by any process returns n, from 0. None: one of them is lost, and the others end too.
    virtual std::optional<std::int64_t> take_number() = 0;

    /// Waits until all have got here. @throws ProcessLost
    virtual void wait_for_all() = 0;

    /// To be called when nobody of this process takes numbers any more. Joins the metadata and sums of all parts two by
    /// two, neighbours first, the lower rank's on the left. @returns all of them on rank 0, and nothing of use
    /// elsewhere.
    /// @throws ProcessLost once all that can be reached have got here: their checkpoints are written.
    virtual Picture collect(Picture part, const std::function<Picture(Picture, Picture)>& join) = 0;
};

} // namespace keyhole
