// Several processes that render one picture.
#pragma once

#include "film/picture.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>

namespace keyhole {

/// A process has died, or can't be reached any more. The command line exits with 1.
class TeamLost : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What one process knows of the others. All of them make the same calls, apart from take_number().
class Team {
  public:
    virtual ~Team() = default;

    virtual int rank() const = 0; ///< rank 0 talks and writes

    /// The n-th call made by any process returns n, from 0. None: one of them is lost, and the others end too.
    virtual std::optional<std::int64_t> take_number() = 0;

    /// Waits until all have got here. @throws TeamLost
    virtual void wait_for_all() = 0;

    /// To be called when nobody of this process takes numbers any more. Joins the metadata and sums of all parts two by
    /// two, neighbours first, the lower rank's on the left. @returns all of them on rank 0, and nothing of use
    /// elsewhere.
    /// @throws TeamLost once all that can be reached have got here: their checkpoints are written.
    virtual Picture collect(Picture part, const std::function<Picture(Picture, Picture)>& join) = 0;
};

} // namespace keyhole
