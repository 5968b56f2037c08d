#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

// The thread sanitizer's runtime, where there is one. oneTBB is not instrumented, so the sanitizer must be told that
// whoever starts a loop hands over to its bodies, and they back. This file is not instrumented either (CMakeLists.txt).
extern "C" {
[[gnu::weak]] void __tsan_acquire(void* address);
[[gnu::weak]] void __tsan_release(void* address);
}

namespace keyhole {
namespace {

void acquire(void* address) {
    if (__tsan_acquire != nullptr) __tsan_acquire(address);
}

void release(void* address) {
    if (__tsan_release != nullptr) __tsan_release(address);
}

} // namespace

int busy_cores(int threads) {
    const int all = tbb::info::default_concurrency();
    return threads > 0 ? std::min(threads, all) : all;
}

void with_threads(int threads, const std::function<void()>& body) {
    const int n = threads > 0 ? threads : tbb::info::default_concurrency();
    // More threads than cores need both the control and an arena of that size.
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(n));
    tbb::task_arena arena(n);
    char handover = 0;
    release(&handover);
    arena.execute([&] {
        acquire(&handover);
        body();
        release(&handover);
    });
    acquire(&handover);
}

void parallel_for(std::int64_t n, const std::function<void(std::int64_t)>& body) {
    char begin = 0, end = 0; // apart, so that bodies are not ordered among themselves
    release(&begin);
    const auto annotated_body = [&](std::int64_t i) {
        acquire(&begin);
        body(i);
        release(&end);
    };
    tbb::parallel_for(std::int64_t{0}, n, annotated_body, tbb::simple_partitioner{});
    acquire(&end);
}

} // namespace keyhole
