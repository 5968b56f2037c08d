#include "photonmap/light_chains.h"

#include "core/shared_work.h"
#include "photonmap/light_chain.h"
#include "sampling/primary/primary_start.h"

#include <algorithm>
#include <memory>
#include <tuple>
#include <utility>

namespace keyhole {
namespace {

/// The first stretch, in parts of the whole. It learns how often large steps are accepted, with half of the steps
/// large, and stores nothing.
constexpr std::int64_t kStretch = 32;

/// All chains of both roles.
class LightChains {
  public:
    LightChains(const LightBuilder& builder, const LightChainStart& start, std::uint64_t seed)
        : unit_(start.carriers.target.mean()), scouts_{start.scouts.target, 0, {}}, carriers_{
                                                                                        start.carriers.target, 0, {}} {
        add(builder, PhotonRole::scout, start.scouts.seeds, seed);
        add(builder, PhotonRole::carrier, start.carriers.seeds, seed);
    }

    std::int64_t size() const { return static_cast<std::int64_t>(chains_.size()); }
    std::int64_t carriers() const { return carriers_.chains; }
    const RunningStats& target() const { return carriers_.target; }
    /// What a photon's weight is to be multiplied by in the end, after so many steps that stored.
    double scale(std::int64_t steps) const { return unit_ / static_cast<double>(steps * carriers_.chains); }

    /// Advances every chain and stores nothing.
    void advance(const PrimaryKernel& kernel, std::int64_t steps, const RunContext& context) {
        run(kernel, steps, context, false);
    }
    /// Advances every chain. `large`: as in LightWeights.
    void advance(const PrimaryKernel& kernel, std::int64_t steps, double large, MapStores& stores,
                 const RunContext& context) {
        for (const PhotonRole role : {PhotonRole::scout, PhotonRole::carrier})
            part(role).weights = {unit_, part(role).target.mean(), large, stores.thresholds(role)};
        run(kernel, steps, context, true);
        collect(stores);
    }
    /// Stores what the states still hold.
    void flush(MapStores& stores, const RunContext& context) {
        std::vector<MapBuffers> left(chains_.size());
        shared_for(left, context, [&](std::int64_t c) {
            LightChain& chain = *chains_[static_cast<std::size_t>(c)];
            chain.store(chain.state.sample(), chain.stay, part(chain.role).weights);
            left[static_cast<std::size_t>(c)] = std::exchange(chain.buffers, {});
        });
        for (std::size_t c = 0; c < chains_.size(); ++c) stores.absorb(chains_[c]->role, left[c]);
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
    Part& part(PhotonRole role) { return role == PhotonRole::scout ? scouts_ : carriers_; }

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
    /// What a chain hands on after a round, to all processes.
    struct Haul {
        MapBuffers buffers;
        RunningStats large;
        PrimaryCounts counts;

        auto parts() { return std::tie(buffers, large, counts); }
    };

    void run(const PrimaryKernel& kernel, std::int64_t steps, const RunContext& context, bool storing) {
        std::vector<Haul> hauls(chains_.size());
        shared_for(hauls, context, [&](std::int64_t c) {
            LightChain& chain = *chains_[static_cast<std::size_t>(c)];
            chain.large = {};
            const std::uint64_t failed = chain.counts.large.failed;
            DepositingLightChain space(chain, storing ? &part(chain.role).weights : nullptr);
            for (std::int64_t i = 0; i < steps; ++i) kernel.step(space, chain.rng, chain.counts, space);
            space.settle();
            for (std::uint64_t i = failed; i < chain.counts.large.failed; ++i) chain.large.add(0);
            hauls[static_cast<std::size_t>(c)] = {std::exchange(chain.buffers, {}), chain.large, chain.counts};
            context.advance(static_cast<std::uint64_t>(steps));
        });
        for (std::size_t c = 0; c < chains_.size(); ++c) {
            LightChain& chain = *chains_[c];
            chain.buffers = std::move(hauls[c].buffers);
            chain.counts = hauls[c].counts;
            part(chain.role).target.merge(hauls[c].large);
        }
    }
    void collect(MapStores& stores) {
        for (const auto& chain : chains_) stores.absorb(chain->role, chain->buffers);
    }

    double unit_;
    std::vector<std::unique_ptr<LightChain>> chains_;
    Part scouts_, carriers_;
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
    if (chains.carriers() == 0) return out;
    const std::int64_t per_chain = std::max<std::int64_t>(1, options.mutations / chains.size()),
                       stretch = std::max<std::int64_t>(1, per_chain / kStretch),
                       rest = std::max<std::int64_t>(1, per_chain - stretch),
                       round = round_length(static_cast<std::int64_t>(options.photons), chains.size());
    MapStores stores = make_stores(start.weights, options.rule.caustics, options, rest * chains.size());

    context.begin("photons", static_cast<std::uint64_t>((stretch + rest) * chains.size()), "mutations");
    for (std::int64_t done = 0; done < stretch && !(context.stopped() && done > 0); done += round)
        chains.advance({Failures::reject, 0.5}, std::min(round, stretch - done), context);
    out.rule = large_step_rule(chains.counts());
    out.p_large = options.p_large.value_or(out.rule.p_large);
    const PrimaryKernel kernel{Failures::reject, out.p_large};
    std::int64_t steps = 0;
    // In rounds, so that a stop finds all chains equally long.
    while (steps < rest && !(context.stopped() && steps > 0)) {
        const std::int64_t now = std::min(round, rest - steps);
        chains.advance(kernel, now, options.mis_of_large_steps ? out.p_large : 0.0, stores, context);
        steps += now;
    }
    context.end();
    chains.flush(stores, context);

    out.chains = chains.size();
    out.counts = chains.counts();
    out.target = chains.target();
    out.broken = chains.broken();
    out.bytes = stores.bytes();
    static_cast<Photons&>(out) = stores.release(chains.scale(steps), chains.scale(steps));
    return out;
}

} // namespace keyhole
