// Parallel loops that a crew shares out.
#pragma once

#include "core/bytes.h"
#include "core/interruptible.h"
#include "core/parallel.h"
#include "core/progress.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace keyhole {

/// The part of `n` items that this process does: all of them where it is alone.
inline Range own_part(std::int64_t n, const RunContext& context) {
    if (context.crew == nullptr) return {0, n};
    return split(n, context.crew->size(), context.crew->rank());
}

/// Fills in the items that others have done: items [0, n), where own_part() is done here. T: see ByteWriter.
template <class T> void exchange_parts(std::vector<T>& items, const RunContext& context) {
    if (context.crew == nullptr) return;
    const auto n = static_cast<std::int64_t>(items.size());
    const Range own = own_part(n, context);
    ByteWriter writer;
    for (std::int64_t i = own.begin; i < own.end; ++i) writer.put(items[static_cast<std::size_t>(i)]);
    const auto parts = context.crew->exchange(writer.take(), context.asked_to_stop());
    for (int rank = 0; rank < context.crew->size(); ++rank) {
        if (rank == context.crew->rank()) continue;
        const Range range = split(n, context.crew->size(), rank);
        ByteReader reader(parts[static_cast<std::size_t>(rank)]);
        for (std::int64_t i = range.begin; i < range.end; ++i) reader.get(items[static_cast<std::size_t>(i)]);
    }
}

/// parallel_for() that a crew shares out: body(i) fills in items[i], and depends on i alone. All items are there
/// afterwards, in every process. @throws TeamLost by a crew that has lost a process.
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
/// and end(). @throws TeamLost as shared_for(), and Interrupted.
template <class T, class Body> void shared_blocks(std::vector<T>& items, const RunContext& context, Body&& body) {
    const Range own = own_part(static_cast<std::int64_t>(items.size()), context);
    parallel_for(blocks_of(own), context, [&](std::int64_t b) {
        const Range block{own.begin + b * kBlockOfItems, std::min(own.end, own.begin + (b + 1) * kBlockOfItems)};
        for (std::int64_t i = block.begin; i < block.end; ++i) body(b, i);
        context.advance(static_cast<std::uint64_t>(block.size()));
    });
    exchange_parts(items, context);
}

} // namespace keyhole
