// What a Metropolis proposal is. Knows no rendering.
#pragma once

#include "core/rng.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace keyhole {

/// Why a proposal made no state that could be evaluated. Counted in the ledger.
enum class Failure : std::uint8_t {
    absorbed,      ///< a walk ended where a surface took the light
    no_hit,        ///< a ray met nothing, or left the scene
    blocked,       ///< what was to be joined does not see each other
    outside_image, ///< the eye sees the new end, but not within the image
    signature,     ///< a vertex is specular that must not be, or the other way round, or another than the kind allows
    no_light,      ///< no emitter at the end of the path
    length,        ///< too few or too many vertices
    unchanged,     ///< the old path came out
};
constexpr std::size_t kFailures = 8;
constexpr std::array<std::string_view, kFailures> kFailureNames{"absorbed",  "no_hit",   "blocked", "outside_image",
                                                                "signature", "no_light", "length",  "unchanged"};

/// One kind of proposal over states of type State. Immutable and thread-safe while chains run.
template <class State> class Proposal {
  public:
    virtual ~Proposal() = default;
    virtual std::string_view name() const = 0;

    /// Relative frequency at state x; 0 where this kind can't move x.
    virtual double suitability(const State& x) const = 0;

    /// Draws y ~ T(x -> .) with its target evaluated. None: no light can be carried, for the reason in `why`.
    virtual std::optional<State> propose(const State& x, Rng& rng, Failure& why) const = 0;

    /// T(x -> y), summed over every way in which this kind makes y from x, in the measure of the target.
    virtual double transition_density(const State& x, const State& y) const = 0;
};

} // namespace keyhole
