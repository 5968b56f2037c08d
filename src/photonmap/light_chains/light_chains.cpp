#include "photonmap/light_chains/light_chains.h"

#include "core/shared_work.h"
#include "photonmap/light_chains/light_arrivals.h"
#include "photonmap/map_stores.h"
#include "photonmap/power/power.h"
#include "sampling/primary/primary_chain.h"
#include "sampling/primary/primary_start.h"
#include "sampling/primary/primary_state.h"

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>

namespace keyhole {
namespace {

/// From states to weights of photons. Weights of a step add up to about 1.
struct LightWeights {
    double unit;       ///< target that counts as 1
    double brightness; ///< b, mean target of independent samples
    double large;      ///< probability of large steps, where they deposit on their own account; else 0
    MapStores::Thresholds thresholds;

    double factor(double target) const { return light_chain_weight(target, brightness, large, unit); }
};

struct LightChain : PrimaryChain<PrimaryStateOf<LightBuilder>> {
    const PhotonRole role;

    LightChain(const LightBuilder& builder, PhotonRole of, const Rng& random)
        : PrimaryChain(builder, random), role(of) {}

    void store(const LightArrivals& sample, double weight, const LightWeights& weights, MapBuffers& buffers) {
        const double factor = weight * weights.factor(sample.target());
        for (const Arrival& a : sample.arrivals())
            store_by_roulette(buffers, a.kind, factor * a.weight, weights.thresholds, rng,
                              [&](double /*kept*/) { return a.photon; });
    }
};

/// All chains of both roles.
class LightChains {
  public:
    LightChains(const LightBuilder& builder, const LightChainStart& start, std::uint64_t seed)
        : unit_(start.main_photons.target.mean()), pilots_{start.pilots.target, 0, {}},
          main_photons_{start.main_photons.target, 0, {}} {
        add(builder, PhotonRole::pilot, start.pilots.seeds, seed);
        add(builder, PhotonRole::main_photon, start.main_photons.seeds, seed);
        buffers_.resize(chains_.size());
    }

    std::int64_t size() const { return static_cast<std::int64_t>(chains_.size()); }
    std::int64_t main_photons() const { return main_photons_.chains; }
    const RunningStats& target() const { return main_photons_.target; }
    /// What a photon's weight is to be multiplied by in the end, after so many steps that stored.
    double scale(std::int64_t steps) const { return light_chain_scale(unit_, steps * main_photons_.chains); }

    /// Advances every chain and stores nothing.
    void advance(const PrimaryKernel& kernel, std::int64_t steps, const RunContext& context) {
        run(kernel, steps, context, false);
    }
    /// Advances every chain. `large`: as in LightWeights.
    void advance(const PrimaryKernel& kernel, std::int64_t steps, double large, MapStores& stores,
                 const RunContext& context) {
        for (const PhotonRole role : {PhotonRole::pilot, PhotonRole::main_photon})
            part(role).weights = {unit_, part(role).target.mean(), large, stores.thresholds(role)};
        run(kernel, steps, context, true);
        absorb(stores, context);
    }
    /// Stores what the states still hold.
    void flush(MapStores& stores, const RunContext& context) {
        for (std::int64_t c = 0; c < size(); ++c) {
            LightChain& chain = *chains_[static_cast<std::size_t>(c)];
            if (chain.stay > 0)
                chain.store(chain.state.sample(), chain.stay, part(chain.role).weights,
                            buffers_[static_cast<std::size_t>(c)]);
        }
        absorb(stores, context);
    }

    PrimaryCounts counts() const {
        PrimaryCounts all;
        for (const auto& chain : chains_) all += chain->counts;
        return all;
    }
    std::uint64_t broken() const {
        std::uint64_t n = 0;
        for (const auto& chain : chains_) n += chain->state.broken();
        return n;
    }

  private:
    struct Part {
        RunningStats target; ///< of independent samples and large steps
        std::int64_t chains;
        LightWeights weights;
    };
    Part& part(PhotonRole role) { return role == PhotonRole::pilot ? pilots_ : main_photons_; }

    void add(const LightBuilder& builder, PhotonRole role, const std::vector<std::int64_t>& seeds, std::uint64_t seed) {
        for (const std::int64_t sample : seeds) {
            const auto index = static_cast<std::uint64_t>(chains_.size());
            auto chain = std::make_unique<LightChain>(builder, role, Rng(seed, StreamPurpose::primary_chain, index));
            PrimaryRandom random(seed, sample);
            chain->state.start({random.light, random.choice});
            if (!(chain->state.target() > 0)) continue; // rounding took what little light there was
            ++part(role).chains;
            chains_.push_back(std::move(chain));
        }
    }
    /// What a chain tells after a round, to all processes.
    struct Tally {
        RunningStats large;
        PrimaryCounts counts;
    };

    void run(const PrimaryKernel& kernel, std::int64_t steps, const RunContext& context, bool storing) {
        std::vector<Tally> tallies(chains_.size());
        shared_for(tallies, context, [&](std::int64_t c) {
            const auto at = static_cast<std::size_t>(c);
            LightChain& chain = *chains_[at];
            chain.large = {};
            const std::uint64_t failed = chain.counts.large.failed;
            const LightWeights& weights = part(chain.role).weights;
            DepositingChain space(chain, storing && weights.large > 0, [&](const LightArrivals& sample, double weight) {
                if (storing) chain.store(sample, weight, weights, buffers_[at]);
            });
            for (std::int64_t i = 0; i < steps; ++i) kernel.step(space, chain.rng, chain.counts, space);
            space.drop_candidate();
            if (!storing) chain.stay = 0;
            chain.count_failed_large_steps(failed);
            tallies[at] = {chain.large, chain.counts};
            context.advance(static_cast<std::uint64_t>(steps));
        });
        for (std::size_t c = 0; c < chains_.size(); ++c) {
            chains_[c]->counts = tallies[c].counts;
            part(chains_[c]->role).target.merge(tallies[c].large);
        }
    }
    void absorb(MapStores& stores, const RunContext& context) {
        stores.absorb(
            buffers_, [&](std::size_t c) { return chains_[c]->role; }, context);
    }

    double unit_;
    std::vector<std::unique_ptr<LightChain>> chains_;
    std::vector<MapBuffers> buffers_; ///< by chain
    Part pilots_, main_photons_;
};

/// Stores for what so many steps of all chains leave. The thresholds that the run is expected to end with are there
/// from the start.
MapStores make_stores(const PhotonWeights& weights, bool caustics, const LightChainOptions& options,
                      std::int64_t steps) {
    const double share = weights.known() > 0 ? weights.known_caustic / weights.known() : 0;
    const std::size_t caustic = caustics ? weights.for_caustic(options.photons) : 0, global = options.photons - caustic;
    const auto expected = [&](double part, std::size_t ceiling) {
        return ceiling > 0 ? 0.8 * part * static_cast<double>(steps) / static_cast<double>(ceiling) : 0.0;
    };
    return {global, caustic, {expected(1 - share, global), expected(share, caustic)}, options.seed};
}

} // namespace

LightChainPhotons run_light_chains(const Scene& scene, const EmissionGuide& guide, const LightChainStart& start,
                                   const LightChainOptions& options, const RunContext& context) {
    LightChainPhotons out;
    const LightBuilder builder(scene, {guide, start.weights.unknown_scale()}, options.rule);
    LightChains chains(builder, start, options.seed);
    if (chains.main_photons() == 0) return out;
    const LearningBatch batch(std::max<std::int64_t>(1, options.mutations / chains.size()));
    const std::int64_t round = round_length(static_cast<std::int64_t>(options.photons), chains.size());
    MapStores stores = make_stores(start.weights, options.rule.caustics, options, batch.rest * chains.size());

    context.begin("photons", static_cast<std::uint64_t>((batch.steps + batch.rest) * chains.size()), "mutations");
    const auto [rule, kernel] = learn_large_steps(chains, Failures::reject, options.p_large,
                                                  ChainRounds::of_length(batch.steps, round), context);
    const double large = options.mis_of_large_steps ? kernel.p_large : 0.0;
    const std::int64_t steps = ChainRounds::of_length(batch.rest, round).run(context, [&](std::int64_t n) {
        chains.advance(kernel, n, large, stores, context);
    });
    context.end();
    chains.flush(stores, context);

    out.chains = chains.size();
    out.rule = rule;
    out.p_large = kernel.p_large;
    out.counts = chains.counts();
    out.target = chains.target();
    out.broken = chains.broken();
    out.bytes = stores.bytes();
    static_cast<Photons&>(out) = stores.release(chains.scale(steps), chains.scale(steps));
    return out;
}

} // namespace keyhole
