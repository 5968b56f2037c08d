// Samples in blocks, of which a stop leaves the first ones.
#pragma once

#include "core/shared_work.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace keyhole {

/// Calls make(range) for blocks of `size` of `count` samples on many threads, then use(what it made) one after the
/// other, in their order. After a stop only the leading blocks that were made are used: a valid smaller run. Tells
/// `context` of its progress, between begin() and end(). A crew shares the blocks out; what they make is as ByteWriter
/// has it. @throws TeamLost by a crew that has lost a process.
template <class Make, class Use>
void leading_blocks(std::int64_t count, std::int64_t size, const RunContext& context, Make&& make, Use&& use) {
    std::vector<std::optional<decltype(make(Range{}))>> blocks(static_cast<std::size_t>((count + size - 1) / size));
    shared_for(blocks, context, [&](std::int64_t b) {
        if (context.stopped()) return;
        const Range range{b * size, std::min(count, (b + 1) * size)};
        blocks[static_cast<std::size_t>(b)].emplace(make(range));
        context.advance(static_cast<std::uint64_t>(range.size()));
    });
    for (auto& block : blocks) {
        if (!block) break;
        use(*block);
        block.reset();
    }
}

} // namespace keyhole
