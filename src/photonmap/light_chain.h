// One chain over light sub-paths, and the photons it leaves.
#pragma once

#include "core/statistics.h"
#include "photonmap/light_arrivals.h"
#include "photonmap/map_stores.h"
#include "sampling/primary/primary_kernel.h"
#include "sampling/primary/primary_state.h"

#include <utility>

namespace keyhole {

/// From states to weights of photons. Weights of a step add up to about 1.
struct LightWeights {
    double unit;       ///< target that counts as 1
    double brightness; ///< b, mean target of independent samples
    double large;      ///< probability of large steps, where they deposit on their own account; else 0
    MapStores::Thresholds thresholds;

    double factor(double target) const { return 1 / (unit * (target / brightness + large)); }
};

struct LightChain {
    Rng rng;
    PrimaryStateOf<LightBuilder> state;
    const PhotonRole role;
    MapBuffers buffers;
    PrimaryCounts counts;
    RunningStats large; ///< targets of large steps, of a round
    double stay = 0;    ///< weight that the state has gained and not yet left

    LightChain(const LightBuilder& builder, PhotonRole of, const Rng& random)
        : rng(random), state(builder, rng), role(of) {}

    void store(const LightArrivals& sample, double weight, const LightWeights& weights) {
        if (!(weight > 0)) return;
        const double factor = weight * weights.factor(sample.target());
        for (const Arrival& a : sample.arrivals())
            store_by_roulette(buffers, a.kind, factor * a.weight, weights.thresholds, rng,
                              [&](double /*kept*/) { return a.photon; });
    }
};

/// A chain as the kernel's space. Where a candidate becomes the state, what both deposit makes one photon.
class DepositingLightChain {
  public:
    /// `weights` null: nothing is stored.
    DepositingLightChain(LightChain& chain, const LightWeights* weights) : chain_(&chain), weights_(weights) {}

    double propose(Step step) {
        settle();
        return chain_->state.propose(step);
    }
    double target() const { return chain_->state.target(); }
    void accept() {
        if (weights_ != nullptr) chain_->store(chain_->state.sample(), chain_->stay, *weights_);
        chain_->stay = std::exchange(candidate_, 0);
        chain_->state.accept();
    }
    /// For the kernel.
    void operator()(bool candidate, double weight, bool large) {
        if (candidate && large) chain_->large.add(chain_->state.candidate().target());
        if (weights_ == nullptr) return;
        (candidate ? candidate_ : chain_->stay) += weight + (large && weights_->large > 0 ? 1 : 0);
    }
    /// Stores what a rejected candidate deposits.
    void settle() {
        if (weights_ != nullptr) chain_->store(chain_->state.candidate(), candidate_, *weights_);
        candidate_ = 0;
    }

  private:
    LightChain* chain_;
    const LightWeights* weights_;
    double candidate_ = 0;
};

} // namespace keyhole
