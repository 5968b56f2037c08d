// The seeds of passes, and how their chains become units of work.
#pragma once

#include "core/parallel.h"
#include "core/rng.h"
#include "core/settings.h"

#include <algorithm>
#include <cstdint>

namespace keyhole {

/// Passes have seeds of their own, by their number; the first has the render's.
inline std::uint64_t seed_of_pass(const Settings& settings, std::int64_t pass) {
    if (pass == 0) return settings.seed;
    Rng rng(settings.seed, StreamPurpose::seed_choice, static_cast<std::uint64_t>(pass));
    return static_cast<std::uint64_t>(rng.next() * 0x1p32) << 20 ^ static_cast<std::uint64_t>(rng.next() * 0x1p32);
}

/// For one of the renders that a time is filled with: their errors have to be independent. The first has the seed that
/// was asked for, so that a picture of one render can be made again.
inline std::uint64_t seed_of_render(const Settings& settings, std::int64_t number) {
    if (number == 0) return settings.seed;
    constexpr std::int64_t kBeyondPasses = std::int64_t{1} << 40; // no pass has such a number
    return seed_of_pass(settings, kBeyondPasses + number);
}

/// For trials, whose samples may have no part in what they decide about: it would be chosen for looking good.
inline std::uint64_t seed_of_trial(const Settings& settings) { return seed_of_pass(settings, std::int64_t{1} << 41); }

/// Groups that the chains of a pass are shared out among, of methods that draw what chains find; each is a unit of
/// work. Unless settings.chain_groups says how many, a group makes two million mutations or has 16 chains, whichever is
/// more: enough that saving its picture costs little beside, and little enough that a death costs seconds.
inline std::int64_t chain_groups(const Settings& settings) {
    constexpr std::int64_t kMutations = 2'000'000, kChains = 16;
    if (settings.chain_groups > 0) return std::min(settings.chain_groups, settings.chains);
    return std::clamp<std::int64_t>(settings.mutations / kMutations, 1,
                                    std::max<std::int64_t>(1, settings.chains / kChains));
}

/// Chains of group `group` of so many: one at least, where there are any.
inline Range chains_of_group(std::size_t chains, std::int64_t groups, std::int64_t group) {
    const auto n = static_cast<std::int64_t>(chains);
    const Range range = split(n, groups, group);
    return {range.begin, std::max(range.end, std::min(n, range.begin + 1))};
}

/// Rounds of a pass that are taken along with group `group` of so many: the first has one at least.
inline Range rounds_of_group(std::int64_t rounds, std::int64_t groups, std::int64_t group) {
    return {(group * rounds + groups - 1) / groups, ((group + 1) * rounds + groups - 1) / groups};
}

} // namespace keyhole
