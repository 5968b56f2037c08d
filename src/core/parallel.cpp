#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace keyhole {

void with_threads(int threads, const std::function<void()>& body) {
    const int n = threads > 0 ? threads : tbb::info::default_concurrency();
    // More threads than cores need both the control and an arena of that size.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(n));
    tbb::task_arena arena(n);
    arena.execute(body);
}

void parallel_for(std::int64_t n, const std::function<void(std::int64_t)>& body) {
    tbb::parallel_for(std::int64_t{0}, n, body, tbb::simple_partitioner{});
}

} // namespace keyhole
