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

/// A chain as the kernel's space. What it stays at a state is deposited at once when it leaves, together with what the
/// state brought as a candidate: most of the work of a deposit doesn't depend on its weight.
class PrimaryChains::Depositing {
  public:
    Depositing(PrimaryChains& chains, std::int64_t index, const Weights& weights, double brightness,
               const Deposit& deposit)
        : chain_(chains.chains_[static_cast<std::size_t>(index)].get()), index_(index), monitor_(&chains.monitor_),
          weights_(weights), brightness_(brightness), deposit_(&deposit) {}

    double propose(Step step) {
        drop_candidate();
        return chain_->state.propose(step);
    }
    double target() const { return chain_->state.target(); }
    void accept() {
        leave(chain_->state.sample());
        std::swap(stay_, candidate_);
        chain_->state.accept();
    }
    /// A change of technique before a step. It leaves the same path with another target, by which deposits divide.
    void change(const TechniqueChange& technique) {
        drop_candidate();
        if (technique.move(chain_->state, chain_->rng, chain_->changes)) leave(chain_->state.candidate());
    }
    /// Nothing follows: deposits what is left.
    void end() {
        drop_candidate();
        leave(chain_->state.sample());
    }
    /// For the kernel.
    void operator()(bool candidate, double weight, bool large) {
        if (!candidate) {
            stay_ += weight;
            return;
        }
        const PathSample& sample = chain_->state.candidate();
        if (large) chain_->large.add(sample.target());
        candidate_ = weight + (large && weights_.large > 0 ? 1 : 0);
    }

  private:
    /// The state, or what was it until now, is deposited.
    void leave(const PathSample& state) {
        if (stay_ > 0) splat(state, stay_);
        stay_ = 0;
    }
    /// What wasn't accepted is deposited.
    void drop_candidate() {
        if (candidate_ > 0) splat(chain_->state.candidate(), candidate_);
        candidate_ = 0;
    }
    void splat(const PathSample& sample, double weight) const {
        if (!*deposit_) return;
        const double factor = weight * weights_.factor(sample.target());
        for (const Splat& s : sample.splats()) {
            monitor_->add(index_, s.image, luminance(s.value) * factor / brightness_);
            (*deposit_)(s, factor);
        }
    }

    Chain* chain_;
    std::int64_t index_;
    AgreementMonitor* monitor_;
    Weights weights_;
    double brightness_; ///< of the picture
    const Deposit* deposit_;
    double stay_ = 0, candidate_ = 0; ///< weights that state and candidate are to be deposited with
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
    const double first = s.worth * static_cast<double>(s.brightness.count());
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
        chain.counts = {};
        chain.changes = {};
        const auto& change = (*strata_)[chain.stratum].change;
        chain.large = {};
        chain.state.set_path_kept(false);
        Depositing space(*this, c, by_stratum[chain.stratum], brightness, deposit);
        int left_out = 0;
        for (std::int64_t done = 0; done < steps;) {
            if (change && chain.rng.next() < kChange) space.change(*change);
            const bool counts = kernel.step(space, chain.rng, chain.counts, space);
            left_out = counts ? 0 : left_out + 1;
            if (left_out == kMostLeftOut) space(false, 1, false), left_out = 0, ++done;
            done += counts ? 1 : 0;
        }
        space.end();
        for (std::uint64_t i = 0; i < chain.counts.large.failed; ++i) chain.large.add(0);
        context.advance(static_cast<std::uint64_t>(steps));
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
