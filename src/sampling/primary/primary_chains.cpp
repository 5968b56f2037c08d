#include "sampling/primary/primary_chains.h"

#include "core/parallel.h"

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

template <class Space>
void PrimaryChains::make_steps(Chain& chain, const PrimaryKernel& kernel, std::int64_t steps, Space& space) const {
    const auto& change = (*strata_)[chain.stratum].change;
    int left_out = 0;
    for (std::int64_t done = 0; done < steps;) {
        if (change && chain.rng.next() < kChange) {
            space.drop_candidate();
            // It leaves the same path with another target, by which deposits divide.
            if (change->move(chain.state, chain.rng, chain.changes)) space.leave(chain.state.candidate());
        }
        const bool counts = kernel.step(space, chain.rng, chain.counts, space);
        left_out = counts ? 0 : left_out + 1;
        if (left_out == kMostLeftOut) space(false, 1, false), left_out = 0, ++done;
        done += counts ? 1 : 0;
    }
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
        make_steps(chain, kernel, steps, space);
        space.drop_candidate();
        space.leave(chain.state.sample());
        chain.count_failed_large_steps(0);
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
