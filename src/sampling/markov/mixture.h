// What a Metropolis proposal is, and a state-dependent choice between kinds of it. Knows no rendering.
//
// Kinds of one family are judged together: a candidate counts as made by all of them, weighted with how often each is
// chosen. A kind that rarely finds its own way back, such as a user path, can so return by the other's (Fan, Chenney,
// Lai 2005, section 5.1).
#pragma once

#include "core/rng.h"

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

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

/// Chooses kind k at state x with probability proportional to weight[k] * suitability_k(x). The probability is part of
/// the transition density in both directions. Immutable and thread-safe.
template <class State> class Mixture {
  public:
    /// Kinds of weight 0 are left out. Those of one family make the same moves: their densities are of the same new
    /// coordinates, or zero. kAlone: a family of its own.
    void add(std::unique_ptr<const Proposal<State>> kind, double weight, int family = kAlone) {
        if (weight > 0) kinds_.push_back({std::move(kind), weight, family});
    }
    static constexpr int kAlone = -1;

    std::size_t size() const { return kinds_.size(); }
    const Proposal<State>& kind(std::size_t k) const { return *kinds_[k].proposal; }

    /// Index of a kind that suits x; none if no kind does.
    std::optional<std::size_t> choose(const State& x, Rng& rng) const {
        double left = rng.next() * total(x);
        std::optional<std::size_t> last;
        for (std::size_t k = 0; k < kinds_.size(); ++k) {
            const double w = kinds_[k].weight * kinds_[k].proposal->suitability(x);
            if (w <= 0) continue;
            last = k;
            if ((left -= w) < 0) break;
        }
        return last;
    }

    /// Density of the move x -> y of kind k: its probability times its transition density, summed over its family.
    double density(const State& x, const State& y, std::size_t k) const {
        double sum = 0;
        for (std::size_t i = 0; i < kinds_.size(); ++i) {
            if (i != k && (kinds_[k].family == kAlone || kinds_[i].family != kinds_[k].family)) continue;
            const double w = kinds_[i].weight * kinds_[i].proposal->suitability(x);
            if (w > 0) sum += w * kinds_[i].proposal->transition_density(x, y);
        }
        return sum > 0 ? sum / total(x) : sum;
    }

    /// [f(y) / T(x->y)] / [f(x) / T(y->x)] of a candidate y of kind k: accepted with that probability, if below 1. Not
    /// a number, or infinite, where densities fail.
    double acceptance_ratio(const State& x, const State& y, std::size_t k) const {
        return (y.target / density(x, y, k)) / (x.target / density(y, x, k));
    }

  private:
    struct Kind {
        std::unique_ptr<const Proposal<State>> proposal;
        double weight;
        int family;
    };

    double total(const State& x) const {
        double sum = 0;
        for (const Kind& k : kinds_) sum += k.weight * k.proposal->suitability(x);
        return sum;
    }

    std::vector<Kind> kinds_;
};

} // namespace keyhole
