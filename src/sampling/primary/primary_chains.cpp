#include "sampling/primary/primary_chains.h"

#include "core/parallel.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

namespace keyhole {
namespace {

/// A chain that leaves out this many proposals in a row is told to stay after all: it would never come to an end.
constexpr int kMostLeftOut = 10'000;

/// How often a change of technique goes before a step.
constexpr double kChange = 0.25;

/// From one look at the stop to the next, about [s]: who stops a render waits a second at most.
constexpr double kBetweenLooks = 0.1;

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

    /// Makes so many steps. `change` goes before some of them. What they bring is deposited by then or by finish(), so
    /// that a round is the same however its steps are parted.
    void make_steps(const PrimaryKernel& kernel, std::int64_t steps, const std::optional<ReversibleJump>& change) {
        chain_.state.set_path_kept(false); // others had the thread's rooms
        for (std::int64_t done = 0; done < steps;) {
            if (change && chain_.rng.next() < kChange) {
                drop_candidate();
                // It leaves the same path with another target, by which deposits divide.
                if (change->move(chain_.state, chain_.rng, chain_.changes)) leave(chain_.state.candidate());
            }
            const bool counts = kernel.step(*this, chain_.rng, chain_.counts, *this);
            chain_.left_out = counts ? 0 : chain_.left_out + 1;
            if (chain_.left_out == kMostLeftOut) (*this)(false, 1, false), chain_.left_out = 0, ++done;
            done += counts ? 1 : 0;
        }
    }
    /// Ends a round.
    void finish() {
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
        chain_.stay = std::exchange(chain_.candidate, 0);
        chain_.state.accept();
    }
    void operator()(bool candidate, double weight, bool large) {
        if (!candidate) {
            chain_.stay += weight;
            return;
        }
        if (large) chain_.large.add(chain_.state.candidate().target());
        chain_.candidate = weight + (large && large_count_ ? 1 : 0);
    }

  private:
    /// Deposits what wasn't accepted.
    void drop_candidate() {
        if (chain_.candidate > 0) store_(chain_.state.candidate(), chain_.candidate);
        chain_.candidate = 0;
    }
    /// Deposits `state`, which is the chain's or was it until now.
    void leave(const PathSample& state) {
        if (chain_.stay > 0) store_(state, chain_.stay);
        chain_.stay = 0;
    }

    Chain& chain_;
    bool large_count_;
    Store store_;
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

std::int64_t PrimaryChains::advance(const PrimaryKernel& kernel, std::int64_t steps, const RunContext& context,
                                    const Deposit& deposit) {
    std::vector<Weights> by_stratum;
    for (std::size_t k = 0; k < strata_->size(); ++k) by_stratum.push_back(weights(k, kernel));
    const double brightness = this->brightness();
    const auto for_each = [&](const auto& body) {
        parallel_for(size(), [&](std::int64_t c) {
            Chain& chain = *chains_[static_cast<std::size_t>(c)];
            const Weights& weights = by_stratum[chain.stratum];
            DepositingChain space(chain, weights.large > 0, [&](const PathSample& sample, double weight) {
                if (!deposit) return;
                const double factor = weight * weights.factor(sample.target());
                for (const Splat& s : sample.splats()) {
                    monitor_.add(c, s.image, luminance(s.value) * factor / brightness);
                    deposit(s, factor);
                }
            });
            body(space, (*strata_)[chain.stratum]);
        });
    };
    for (const auto& chain : chains_) chain->begin_round();
    const std::int64_t done = run_until_stopped(steps, context, [&](std::int64_t n) {
        for_each([&](auto& space, const PrimaryStratum& stratum) {
            space.make_steps(kernel, n, stratum.change);
            context.advance(n);
        });
    });
    for_each([](auto& space, const PrimaryStratum& /*stratum*/) { space.finish(); });
    for (const auto& chain : chains_) {
        counts_[chain->stratum] += chain->counts;
        large_[chain->stratum].merge(chain->large);
        changes_ += chain->changes;
    }
    if (deposit) monitor_.end_round(done);
    steps_ += done;
    return done;
}

template <class Make>
std::int64_t PrimaryChains::run_until_stopped(std::int64_t steps, const RunContext& context, const Make& make) {
    using Clock = StopToken::Clock;
    std::int64_t done = 0;
    while (done < steps && !(done > 0 && context.stopped())) {
        const std::int64_t n = std::min(between_looks_, steps - done);
        const auto start = Clock::now();
        make(n);
        done += n;
        const bool soon = std::chrono::duration<double>(Clock::now() - start).count() < kBetweenLooks;
        between_looks_ = soon ? std::max(between_looks_, 2 * n) : std::max<std::int64_t>(1, n / 2);
    }
    return done;
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
