// Loops of stages whose results are of no use in part.
#pragma once

#include "core/parallel.h"
#include "core/progress.h"

#include <stdexcept>

namespace keyhole {

/// Thrown where a stage was stopped before it had a result. Whoever has something to show without it catches this.
struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("stopped before there was a result") {}
};

/// @throws Interrupted if it is time to stop. A crew ends together, where it can agree on it: not here.
inline void check_stop(const RunContext& context) {
    if (context.crew == nullptr && context.asked_to_stop()) throw Interrupted();
}

/// parallel_for() that looks before each item whether it is time to stop: an item is some milliseconds of work.
/// @throws Interrupted
template <class Body> void parallel_for(std::int64_t n, const RunContext& context, Body&& body) {
    parallel_for(n, [&](std::int64_t i) {
        check_stop(context);
        body(i);
    });
}

/// The same for items that take little time each: `block` of them between two looks.
/// @throws Interrupted
template <class Body> void parallel_blocks(std::int64_t n, std::int64_t block, const RunContext& context, Body&& body) {
    parallel_for((n + block - 1) / block, context, [&](std::int64_t b) {
        for (std::int64_t i = b * block; i < std::min(n, (b + 1) * block); ++i) body(i);
    });
}

} // namespace keyhole
