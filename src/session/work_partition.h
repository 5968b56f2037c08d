// A share of a render, and what becomes of it.
#pragma once

#include "core/progress.h"
#include "film/picture.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

namespace keyhole {

/// A render is a row of units of work: rounds of one sample for each pixel (settings.spp of them to a pass), or, of
/// methods whose chains draw, groups of the chains of a pass. The random streams of a unit follow from its number
/// alone, and sums of units don't depend on how they are grouped (AccumulationBuffer), so that any process may do any
/// of them.
struct WorkPartition {
    std::int64_t first_pass = 0;
    std::optional<std::int64_t> end_pass; ///< the pass after the last one; none: settings.passes

    /// Where to go on; null: from the start. A picture that was saved by a render of the same scene and settings.
    /// Without its sums it only says which units others have done.
    const Picture* done = nullptr;

    /// The picture is to have its sums, and metadata "units" that says which they are the sums of.
    bool keep_sums = false;
    /// Called between units with such a picture of all that is done, once `save_every` seconds have gone by since the
    /// last time, and at the end. May be empty.
    std::function<void(const Picture&)> save;
    double save_every = std::numeric_limits<double>::infinity();

    /// Called between units with the picture so far, where `wants_look` says so. Both may be empty.
    std::function<void(const Picture&)> look;
    std::function<bool()> wants_look;

    /// Of the time until the stop, what photons leave to the gather, in each pass [s].
    double for_gather = 0;

    /// Photon maps are checked for false spots in the end; trials do without.
    bool checks_photons = true;

    /// Tells different processes what to do: the n-th call made by any of them returns n, from 0; none: it is time to
    /// stop. Empty: there is only this process.
    std::function<std::optional<std::int64_t>()> take_number;
    std::int64_t processes = 1; ///< that take numbers
    /// All processes, which do what comes before the first unit of a pass together where there are fewer passes than
    /// processes. Null: there is only this one.
    Communicator* communicator = nullptr;

    /// Whether one process does all of it from begin to end, and nothing of it is kept to go on from.
    bool is_whole_render() const {
        return first_pass == 0 && !end_pass && done == nullptr && !keep_sums && !save && !take_number;
    }
};

} // namespace keyhole
