// Parallel loops over work that was split beforehand.
#pragma once

#include <cstdint>
#include <functional>

namespace keyhole {

/// Cores that so many threads keep busy (0: all).
int busy_cores(int threads = 0);

/// Limits every parallel loop made inside `body` to `threads` threads (0: all cores; more than the cores is allowed).
void with_threads(int threads, const std::function<void()>& body);

/// Calls `body(i)` for i in [0, n), each once, in any order, on many threads. Results must depend on `i` alone: random
/// streams and output slots are indexed by i, so that the outcome does not depend on the number of threads.
void parallel_for(std::int64_t n, const std::function<void(std::int64_t)>& body);

/// The bounds of part `i` of `parts` of a range of `total` items, split exactly.
struct Range {
    std::int64_t begin, end;
    std::int64_t size() const { return end - begin; }
};
inline Range split(std::int64_t total, std::int64_t parts, std::int64_t i) {
    return {i * total / parts, (i + 1) * total / parts};
}

} // namespace keyhole
