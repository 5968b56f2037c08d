#include "sampling/primary/primary_chains.h"

#include "core/parallel.h"

#include <cmath>
#include <optional>
#include <utility>

namespace keyhole {
namespace {

/// A chain that leaves out this many proposals in a row is told to stay after all: it would never come to an end.
constexpr int kMostLeftOut = 10'000;

/// How often a change of technique goes before a step.
constexpr double kChange = 0.25;

/// The number that chooses a technique, where a seed prescribes one.
class Fixed final : public SampleSource {
  public:
    explicit Fixed(double u) : u_(u) {}
    double next() override { return u_; }

  private:
    double u_;
};

} // namespace

/// A chain as the kernel's space. What it stays at a state is deposited at once when it leaves, together with what the
/// state brought as a candidate: most of the work of a deposit doesn't depend on its weight. Large steps are samples on
/// their own account, too (Kelemen et al. 2002, section 3.4), where `large_count` says so.
///
/// `Store`: store(sample, weight), for positive weights.
template <class Store> class PrimaryChains::DepositingChain {
  public:
    DepositingChain(Chain& chain, bool large_count, Store store)
        : chain_(chain), large_count_(large_count), store_(std::move(store)) {}

    /// Makes so many steps and deposits all that they bring. `change` goes before some of them.
    void make_steps(const PrimaryKernel& kernel, std::int64_t steps, const std::optional<ReversibleJump>& change) {
        int left_out = 0;
        for (std::int64_t done = 0; done < steps;) {
            if (change && chain_.rng.next() < kChange) {
                drop_candidate();
                // It leaves the same path with another target, by which deposits divide.
                if (change->move(chain_.state, chain_.rng, chain_.changes)) leave(chain_.state.candidate());
            }
            const bool counts = kernel.step(*this, chain_.rng, chain_.counts, *this);
            left_out = counts ? 0 : left_out + 1;
            if (left_out == kMostLeftOut) (*this)(false, 1, false), left_out = 0, ++done;
            done += counts ? 1 : 0;
        }
        drop_candidate();
        leave(chain_.state.sample());
        for (std::uint64_t i = 0; i < chain_.counts.large.failed; ++i) chain_.large.add(0); // of target 0
    }

    // For the kernel.
    double propose(Step step) {
        drop_candidate();
        return chain_.state.propose(step);
    }
    double target() const { return chain_.state.target(); }
    void accept() {
        leave(chain_.state.sample());
        chain_.stay = std::exchange(candidate_, 0);
        chain_.state.accept();
    }
    void operator()(bool candidate, double weight, bool large) {
        if (!candidate) {
            chain_.stay += weight;
            return;
        }
        if (large) chain_.large.add(chain_.state.candidate().target());
        candidate_ = weight + (large && large_count_ ? 1 : 0);
    }

  private:
    /// Deposits what wasn't accepted.
    void drop_candidate() {
        if (candidate_ > 0) store_(chain_.state.candidate(), candidate_);
        candidate_ = 0;
    }
    /// Deposits `state`, which is the chain's or was it until now.
    void leave(const PathSample& state) {
        if (chain_.stay > 0) store_(state, chain_.stay);
        chain_.stay = 0;
    }

    Chain& chain_;
    bool large_count_;
    Store store_;
    double candidate_ = 0; ///< weight that the candidate is to be deposited with
};

PrimaryChains::PrimaryChains(const std::vector<PrimaryStratum>& strata, std::uint64_t seed, bool mis_of_large_steps,
                             std::uint64_t group)
    : strata_(&strata), mis_of_large_steps_(mis_of_large_steps), members_(strata.size()), large_(strata.size()),
      counts_(strata.size()) {
    for (std::size_t k = 0; k < strata.size(); ++k)
        for (const PrimarySeed& s : strata[k].seeds) {
            const auto index = group << 32 | static_cast<std::uint64_t>(chains_.size());
            auto chain = std::make_unique<Chain>(*strata[k].builder, k, Rng(seed, StreamPurpose::primary_chain, index));
            PrimaryRandom random(seed, s.sample);
            Fixed prescribed(s.choice);
            SampleSource& choice = s.choice < 0 ? static_cast<SampleSource&>(random.choice) : prescribed;
            chain->state.start({random.eye, random.light, choice});
            if (!(chain->state.target() > 0)) continue; // rounding took what little light there was
            chains_.push_back(std::move(chain));
            ++members_[k];
        }
}

PrimaryChains::Estimate PrimaryChains::estimate(std::size_t stratum) const {
    const PrimaryStratum& s = (*strata_)[stratum];
    const RunningStats& large = large_[stratum];
    const double first = s.large_steps_per_sample * static_cast<double>(s.brightness.count());
    const double share = first / (first + static_cast<double>(large.count()));
    return {share * s.brightness.mean() + (1 - share) * large.mean(),
            std::hypot(share * s.brightness.standard_error(), (1 - share) * large.standard_error())};
}

PrimaryChains::Weights PrimaryChains::weights(std::size_t stratum, const PrimaryKernel& kernel) const {
    double counted = 1; // share of proposals
    if (kernel.failures == Failures::exclude || kernel.failures == Failures::exclude_large)
        counted -= kernel.p_large * counts_[stratum].large.failure_rate();
    if (kernel.failures == Failures::exclude) counted -= (1 - kernel.p_large) * counts_[stratum].small.failure_rate();
    return {estimate(stratum).mean, mis_of_large_steps_ ? kernel.p_large / counted : 0.0,
            static_cast<double>(size()) / static_cast<double>(members_[stratum])};
}

void PrimaryChains::advance(const PrimaryKernel& kernel, std::int64_t steps, const RunContext& context,
                            const Deposit& deposit) {
    std::vector<Weights> by_stratum;
    for (std::size_t k = 0; k < strata_->size(); ++k) by_stratum.push_back(weights(k, kernel));
    const double brightness = this->brightness();
    parallel_for(size(), [&](std::int64_t c) {
        Chain& chain = *chains_[static_cast<std::size_t>(c)];
        const Weights& weights = by_stratum[chain.stratum];
        chain.begin_round();
        DepositingChain space(chain, weights.large > 0, [&](const PathSample& sample, double weight) {
            if (!deposit) return;
            const double factor = weight * weights.factor(sample.target());
            for (const Splat& s : sample.splats()) {
                monitor_.add(c, s.image, luminance(s.value) * factor / brightness);
                deposit(s, factor);
            }
        });
        space.make_steps(kernel, steps, (*strata_)[chain.stratum].change);
        context.advance(steps);
    });
    for (const auto& chain : chains_) {
        counts_[chain->stratum] += chain->counts;
        large_[chain->stratum].merge(chain->large);
        changes_ += chain->changes;
    }
    if (deposit) monitor_.end_round(steps);
    steps_ += steps;
}

PrimaryCounts PrimaryChains::counts() const {
    PrimaryCounts all;
    for (const PrimaryCounts& c : counts_) all += c;
    return all;
}

double PrimaryChains::brightness() const {
    double sum = 0;
    for (std::size_t k = 0; k < strata_->size(); ++k) sum += estimate(k).mean;
    return sum;
}

double PrimaryChains::brightness_error() const {
    double squares = 0;
    for (std::size_t k = 0; k < strata_->size(); ++k) squares += estimate(k).error * estimate(k).error;
    return std::sqrt(squares);
}

std::uint64_t PrimaryChains::broken() const {
    std::uint64_t n = 0;
    for (const auto& chain : chains_) n += chain->state.broken();
    return n;
}

} // namespace keyhole
