#include "scene/ray_counter.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace keyhole {
namespace {

/// One counter a thread, on a cache line of its own; written by its thread only, read by rays_traced().
struct alignas(64) Counter {
    std::atomic<std::uint64_t> rays{0};
};

std::mutex counters_mutex;
std::vector<std::unique_ptr<Counter>> counters; // outlive their threads

Counter& make_counter() {
    const std::lock_guard lock(counters_mutex);
    return *counters.emplace_back(std::make_unique<Counter>());
}

} // namespace

void count_ray() {
    thread_local Counter& counter = make_counter();
    counter.rays.store(counter.rays.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

std::uint64_t rays_traced() {
    const std::lock_guard lock(counters_mutex);
    std::uint64_t total = 0;
    for (const auto& c : counters) total += c->rays.load(std::memory_order_relaxed);
    return total;
}

} // namespace keyhole
