// The seeds of passes.
#pragma once

#include "core/rng.h"
#include "core/settings.h"

namespace keyhole {

/// Passes have seeds of their own, by their number; the first has the render's.
inline std::uint64_t seed_of_pass(const Settings& settings, std::int64_t pass) {
    const auto seed = static_cast<std::uint64_t>(settings.seed);
    if (pass == 0) return seed;
    Rng rng(seed, StreamPurpose::seed_choice, static_cast<std::uint64_t>(pass));
    return static_cast<std::uint64_t>(rng.next() * 0x1p32) << 20 ^ static_cast<std::uint64_t>(rng.next() * 0x1p32);
}

/// For one of the renders that a time is filled with: their errors have to be independent.
inline std::int64_t seed_of_render(const Settings& settings, std::int64_t number) {
    constexpr std::int64_t kBeyondPasses = std::int64_t{1} << 40; // no pass has such a number
    return static_cast<std::int64_t>(seed_of_pass(settings, kBeyondPasses + number));
}

/// For trials, whose samples may have no part in what they decide about: it would be chosen for looking good.
inline std::uint64_t seed_of_trial(const Settings& settings) { return seed_of_pass(settings, std::int64_t{1} << 41); }

} // namespace keyhole
