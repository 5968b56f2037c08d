// Parallel loops that can be stopped, and those that a process group shares out.
#pragma once

#include "core/bytes.h"
#include "core/parallel.h"
#include "core/progress.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace keyhole {

/// Thrown where a stage was stopped before it had a result. Whoever has something to show without it catches this.
struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("stopped before there was a result") {}
};

/// @throws Interrupted if it is time to stop. A process group ends together, where it can agree on it: not here.
inline void check_stop(const RunContext& context) {
    if (context.communicator == nullptr && context.asked_to_stop()) throw Interrupted();
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

/// What make(range) gives of blocks of `size` of the items, in their order; made on many threads. @throws Interrupted
template <class Make> auto make_blocks(Range items, std::int64_t size, const RunContext& context, const Make& make) {
    std::vector<decltype(make(items))> blocks(static_cast<std::size_t>((items.size() + size - 1) / size));
    parallel_for(static_cast<std::int64_t>(blocks.size()), context, [&](std::int64_t b) {
        const std::int64_t begin = items.begin + b * size;
        blocks[static_cast<std::size_t>(b)] = make(Range{begin, std::min(items.end, begin + size)});
    });
    return blocks;
}

/// The part of `n` items that this process does: all of them where it is alone.
inline Range own_part(std::int64_t n, const RunContext& context) {
    if (context.communicator == nullptr) return {0, n};
    return split(n, context.communicator->size(), context.communicator->rank());
}

/// Fills in the items that others have done: items [0, n), where own_part() is done here. T: see ByteWriter.
template <class T> void exchange_parts(std::vector<T>& items, const RunContext& context) {
    if (context.communicator == nullptr) return;
    const auto n = static_cast<std::int64_t>(items.size());
    const Range own = own_part(n, context);
    ByteWriter writer;
    for (std::int64_t i = own.begin; i < own.end; ++i) writer.put(items[static_cast<std::size_t>(i)]);
    const auto parts = context.communicator->exchange(writer.take(), context.asked_to_stop());
    for (int rank = 0; rank < context.communicator->size(); ++rank) {
        if (rank == context.communicator->rank()) continue;
        const Range range = split(n, context.communicator->size(), rank);
        ByteReader reader(parts[static_cast<std::size_t>(rank)]);
        for (std::int64_t i = range.begin; i < range.end; ++i) reader.get(items[static_cast<std::size_t>(i)]);
    }
}

/// parallel_for() that a process group shares out: body(i) fills in items[i], and depends on i alone. All items are
/// there afterwards, in every process. @throws ProcessLost by a process group that has lost a process.
template <class T, class Body> void shared_for(std::vector<T>& items, const RunContext& context, Body&& body) {
    const Range own = own_part(static_cast<std::int64_t>(items.size()), context);
    parallel_for(own.size(), [&](std::int64_t k) { body(own.begin + k); });
    exchange_parts(items, context);
}

/// Blocks of shared_blocks(), for the items that this process does.
constexpr std::int64_t kBlockOfItems = 256;
inline std::int64_t blocks_of(Range own) { return (own.size() + kBlockOfItems - 1) / kBlockOfItems; }

/// shared_for() for items that take little time each: body(b, i) fills in items[i], which is one of block b of
/// own_part(). A block is done by one thread, in order. Tells `context` of the own items that are done, between begin()
/// and end(). @throws ProcessLost as shared_for(), and Interrupted.
template <class T, class Body> void shared_blocks(std::vector<T>& items, const RunContext& context, Body&& body) {
    const Range own = own_part(static_cast<std::int64_t>(items.size()), context);
    parallel_for(blocks_of(own), context, [&](std::int64_t b) {
        const Range block{own.begin + b * kBlockOfItems, std::min(own.end, own.begin + (b + 1) * kBlockOfItems)};
        for (std::int64_t i = block.begin; i < block.end; ++i) body(b, i);
        context.advance(block.size());
    });
    exchange_parts(items, context);
}

/// Calls make(range) for blocks of `size` of `count` samples on many threads, then use(what it made) one after the
/// other, in their order. After a stop only the leading blocks that were made are used: a valid smaller run. Tells
/// `context` of its progress, between begin() and end(). A process group shares the blocks out; what they make is as
/// ByteWriter has it. @throws ProcessLost by a process group that has lost a process.
template <class Make, class Use>
void leading_blocks(std::int64_t count, std::int64_t size, const RunContext& context, Make&& make, Use&& use) {
    std::vector<std::optional<decltype(make(Range{}))>> blocks(static_cast<std::size_t>((count + size - 1) / size));
    shared_for(blocks, context, [&](std::int64_t b) {
        if (context.stopped()) return;
        const Range range{b * size, std::min(count, (b + 1) * size)};
        blocks[static_cast<std::size_t>(b)].emplace(make(range));
        context.advance(range.size());
    });
    for (auto& block : blocks) {
        if (!block) break;
        use(*block);
        block.reset();
    }
}

} // namespace keyhole
