// Several processes that render one picture.
#pragma once

#include "film/picture.h"

#include <cstdint>
#include <functional>

namespace keyhole {

/// What one process knows of the others. All of them make the same calls, apart from take_number().
class Team {
  public:
    virtual ~Team() = default;

    virtual int rank() const = 0; ///< rank 0 talks and writes

    /// The n-th call made by any process returns n, from 0.
    virtual std::int64_t take_number() = 0;

    /// Waits until all have got here.
    virtual void wait_for_all() = 0;

    /// To be called when nobody of this process takes numbers any more. On rank 0 `join` is called with the metadata
    /// and sums of every other process' `part`, in the order of their ranks.
    virtual void collect(const Picture& part, const std::function<void(Picture)>& join) = 0;
};

} // namespace keyhole
