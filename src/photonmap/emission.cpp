#include "photonmap/emission.h"

#include "core/shared_work.h"
#include "photonmap/map_stores.h"
#include "sampling/guided_light.h"

#include <algorithm>
#include <limits>

namespace keyhole {
namespace {

/// Photons of a block of paths, and what the weighing of later ones learns from them.
struct Block {
    MapBuffers scouts, carriers;
    PhotonWeights weights;
    std::uint64_t arrivals = 0;

    void learn(const Block& o) {
        weights += o.weights;
        arrivals += o.arrivals;
    }
    auto parts() { return std::tie(scouts, carriers, weights, arrivals); }
};

/// Receives the arrivals of one light path after the other.
class Collector {
  public:
    Collector(const PhotonWeighing& weighing, const MapStores::Thresholds& scouts,
              const MapStores::Thresholds& carriers, const StorageRule& rule)
        : weighing_(weighing), scouts_(scouts), carriers_(carriers), rule_(rule) {}

    void begin(PhotonRole role, Rng& rng) {
        role_ = role;
        rng_ = &rng;
    }

    bool arrival(const Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast& past) {
        if (!v.bsdf.traits().finite) return true;
        const StorageRule::Kinds kinds = rule_(v.point, to_light, past.scatterings + 1, past);
        if (kinds.global) store(PhotonKind::global, v, to_light, power);
        if (kinds.caustic) store(PhotonKind::caustic, v, to_light, power);
        return true;
    }

    Block block;

  private:
    void store(PhotonKind kind, const Vertex& v, const Vec3& to_light, const Rgb& power) {
        if (!(luminance(power) > 0)) return;
        const PhotonWeighing::Weight weight = weighing_(kind, v, to_light, power);
        ++block.arrivals;
        block.weights.add(kind, weight, luminance(power));
        const bool scout = role_ == PhotonRole::scout;
        store_by_roulette(
            scout ? block.scouts : block.carriers, kind, weight.value, scout ? scouts_ : carriers_, *rng_,
            [&](double /*kept*/) { return Photon(v.point.p, v.point.ng, to_light, power / weight.value); });
    }

    PhotonWeighing weighing_;
    MapStores::Thresholds scouts_, carriers_;
    StorageRule rule_;
    PhotonRole role_ = PhotonRole::carrier;
    Rng* rng_ = nullptr;
};

constexpr std::int64_t kBlock = 64;   // paths
constexpr std::int64_t kPilot = 8192; // paths

Block trace_block(const Scene& scene, const EmissionOptions& options, Range paths, Collector collector) {
    for (std::int64_t i = paths.begin; i < paths.end; ++i) {
        Rng rng(options.seed, StreamPurpose::emission, static_cast<std::uint64_t>(i));
        collector.begin(role_of_sample(i), rng);
        trace_light_path(scene, options.user_paths, options.rule.max_scatterings, rng, collector);
    }
    return std::move(collector.block);
}

/// Traces a range of paths in blocks, in parallel.
std::vector<Block> trace_blocks(const Scene& scene, const EmissionOptions& options, Range paths,
                                const Collector& collector, const RunContext& context) {
    std::vector<Block> blocks(static_cast<std::size_t>((paths.size() + kBlock - 1) / kBlock));
    shared_for(blocks, context, [&](std::int64_t b) {
        const std::int64_t begin = paths.begin + b * kBlock;
        blocks[static_cast<std::size_t>(b)] =
            trace_block(scene, options, {begin, std::min(begin + kBlock, paths.end)}, collector);
    });
    return blocks;
}

/// Weights of the first paths; nothing is stored.
Block learn_from_pilot(const Scene& scene, const EmissionGuide& guide, const EmissionOptions& options,
                       const RunContext& context) {
    const double infinity = std::numeric_limits<double>::infinity();
    const MapStores::Thresholds never{infinity, infinity};
    Block sum;
    for (const Block& b : trace_blocks(scene, options, {0, std::min(kPilot, options.paths)},
                                       Collector({guide, 1}, never, never, options.rule), context))
        sum.learn(b);
    sum.arrivals = 0;
    return sum;
}

} // namespace

EmittedPhotons emit_photons(const Scene& scene, const EmissionGuide& guide, const EmissionOptions& options,
                            const RunContext& context) {
    EmittedPhotons out;
    if (scene.emitter_distribution().empty()) return out;
    Block learnt = learn_from_pilot(scene, guide, options, context);
    const std::size_t for_caustic = options.rule.caustics ? learnt.weights.for_caustic(options.photons) : 0;
    MapStores stores(options.photons - for_caustic, for_caustic, {}, options.seed);

    // In rounds, so that buffers stay small beside the stores, and thresholds follow what is stored.
    const std::int64_t round =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(options.photons) / 32 / kBlock, 4, 512) * kBlock;
    context.begin("photons", static_cast<std::uint64_t>(options.paths), "light paths");
    while (out.paths < options.paths && !(context.stopped() && out.paths > 0)) {
        const Range range{out.paths, std::min(options.paths, out.paths + round)};
        const PhotonWeighing weighing{guide, learnt.weights.unknown_scale()};
        const Collector collector(weighing, stores.thresholds(PhotonRole::scout),
                                  stores.thresholds(PhotonRole::carrier), options.rule);
        for (Block& b : trace_blocks(scene, options, range, collector, context)) {
            stores.absorb(PhotonRole::scout, b.scouts);
            stores.absorb(PhotonRole::carrier, b.carriers);
            learnt.learn(b);
        }
        out.paths = range.end;
        context.advance(static_cast<std::uint64_t>(range.size()));
    }
    context.end();
    out.arrivals = learnt.arrivals;
    const std::int64_t carriers = out.paths - out.paths / kScoutEvery;
    const double scale = 1 / static_cast<double>(carriers);
    out.bytes = stores.bytes();
    static_cast<Photons&>(out) = stores.release(scale, scale);
    return out;
}

} // namespace keyhole
