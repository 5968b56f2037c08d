#include "photonmap/emission.h"

#include "core/shared_work.h"
#include "photonmap/map_stores.h"
#include "photonmap/power.h"
#include "sampling/guidance/guided_light.h"
#include "sampling/paths/lamps_in_lobes.h"

#include <algorithm>
#include <limits>

namespace keyhole {
namespace {

/// Photons of a block of paths, and what the weighing of later ones learns from them.
struct EmissionBlock {
    MapBuffers pilots, main_photons;
    PhotonWeights weights;
    std::uint64_t arrivals = 0;
    double cut = 0; // visible power of what was too bright [W]

    void learn(const EmissionBlock& o) {
        weights += o.weights;
        arrivals += o.arrivals;
        cut += o.cut;
    }
    auto parts() { return std::tie(pilots, main_photons, weights, arrivals, cut); }
};

/// Receives the arrivals of one light path after the other.
class Collector {
  public:
    Collector(const Scene& scene, const EmissionOptions& options, const PhotonWeighing& weighing,
              const MapStores::Thresholds& pilots, const MapStores::Thresholds& main_photons)
        : scene_(scene), weighing_(weighing), pilots_(pilots), main_photons_(main_photons), rule_(options.rule),
          techniques_(options.weights), unit_(unit_of_power(scene)), observer_(options.observer) {}

    void begin(PhotonRole role, Rng& rng) {
        role_ = role;
        rng_ = &rng;
    }

    void sets_out(const SurfacePoint& x0, bool guided) {
        large_lamp_ = is_large_lamp(scene_, x0);
        if (observer_ == nullptr) return;
        trail_.assign(1, {x0.p, false, x0.site == Site::infinite});
        emitter_ = x0.emitter;
        guided_ = guided;
    }
    void passes(const Vertex& v) {
        if (observer_ != nullptr) trail_.push_back({v.point.p, v.specular()});
    }

    bool arrival(Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast& past) {
        // Of a vertex with both a finite and a specular part nobody knows yet how light goes on.
        if (observer_ != nullptr) trail_.push_back({v.point.p, !v.bsdf.traits().finite});
        if (!v.bsdf.traits().finite) return true;
        const StorageRule::Kinds kinds = rule_(v, to_light, past);
        if (kinds.global) store(PhotonKind::global, v, to_light, power, past);
        if (kinds.caustic) store(PhotonKind::caustic, v, to_light, power, past);
        return true;
    }

    EmissionBlock block;

  private:
    void store(PhotonKind kind, const Vertex& v, const Vec3& to_light, Rgb power, const LightPast& past) {
        if (!(luminance(power) > 0)) return;
        PhotonWeighing::Weight weight = weighing_(kind, v, to_light, power);
        if (const double most = weighing_.most_visible;
            kind == PhotonKind::global && weight.known && weight.value > most) {
            block.cut += weight.value - most;
            power *= most / weight.value;
            weight.value = most;
        }
        const double share = techniques_ != nullptr ? techniques_->of_light_path(weight) : 1;
        ++block.arrivals;
        block.weights.add(kind, weight, luminance(power));
        const bool pilot = role_ == PhotonRole::pilot;
        bool kept = false;
        store_by_roulette(pilot ? block.pilots : block.main_photons, kind, share * weight.value,
                          pilot ? pilots_ : main_photons_, *rng_, [&](double /*weight*/) {
                              const Photon photon(
                                  v.point.p, v.point.ng, to_light, emitted_power(power, weight.value) / unit_,
                                  {.caustic = past.caustic() && (kind == PhotonKind::global || large_lamp_),
                                   .spare = spare(kind, past)});
                              kept = true;
                              if (observer_ != nullptr)
                                  observer_->stored(photon, {trail_, trail_.size() - 1, emitter_, guided_});
                              return photon;
                          });
        if (observer_ != nullptr && !kept) observer_->thrown_away(v.point.p);
    }

    int spare(PhotonKind kind, const LightPast& past) const {
        return spare_scatterings(kind, past.scatterings + 1, rule_.max_scatterings);
    }

    const Scene& scene_;
    PhotonWeighing weighing_;
    MapStores::Thresholds pilots_, main_photons_;
    StorageRule rule_;
    const TechniqueWeights* techniques_;
    double unit_; // of power
    PhotonRole role_ = PhotonRole::main_photon;
    Rng* rng_ = nullptr;
    PhotonObserver* observer_;
    std::vector<TrailPoint> trail_; // kept only where somebody watches
    std::uint32_t emitter_ = SurfacePoint::kNone;
    bool guided_ = false;
    bool large_lamp_ = false; // that the path set out from
};

constexpr std::int64_t kPathsOfBlock = 64; // paths
constexpr std::int64_t kPilot = 8192;      // paths

/// Visible power that a photon may have, where `paths` are traced of which `known` left these weights.
double most_visible(const PhotonWeights& weights, std::int64_t known, std::int64_t paths) {
    const auto seen = static_cast<double>(weights.seen);
    if (!(seen > 0)) return std::numeric_limits<double>::infinity();
    const double in_all = seen * static_cast<double>(paths) / static_cast<double>(known);
    return outlier_bound(weights.known() / seen, in_all);
}

void trace_one(const Scene& scene, const EmissionOptions& options, Rng& rng, Collector& collector) {
    const int depth = options.rule.max_scatterings;
    const LightPathSampling sampling{&options.user_paths, options.learned};
    if (options.scattering == nullptr || sampling.guided())
        return trace_light_path(scene, sampling, depth, rng, collector);
    if (const auto light = sampling.emit(scene, rng))
        trace_light_path(scene, *light, depth, rng, collector, *options.scattering);
}

EmissionBlock trace_block(const Scene& scene, const EmissionOptions& options, Range paths, Collector collector) {
    for (std::int64_t i = paths.begin; i < paths.end; ++i) {
        Rng rng(options.seed, StreamPurpose::emission, static_cast<std::uint64_t>(i));
        collector.begin(role_of_sample(i), rng);
        trace_one(scene, options, rng, collector);
    }
    return std::move(collector.block);
}

/// Traces a range of paths in blocks, in parallel.
std::vector<EmissionBlock> trace_blocks(const Scene& scene, const EmissionOptions& options, Range paths,
                                        const Collector& collector, const RunContext& context) {
    std::vector<EmissionBlock> blocks(static_cast<std::size_t>((paths.size() + kPathsOfBlock - 1) / kPathsOfBlock));
    shared_for(blocks, context, [&](std::int64_t b) {
        const std::int64_t begin = paths.begin + b * kPathsOfBlock;
        blocks[static_cast<std::size_t>(b)] =
            trace_block(scene, options, {begin, std::min(begin + kPathsOfBlock, paths.end)}, collector);
    });
    return blocks;
}

/// Weights of the first paths; nothing is stored.
EmissionBlock learn_from_pilot(const Scene& scene, const EmissionGuide& guide, const EmissionOptions& options,
                               const RunContext& context) {
    const double infinity = std::numeric_limits<double>::infinity();
    const MapStores::Thresholds never{infinity, infinity};
    EmissionOptions alone = options;
    alone.weights = nullptr;
    alone.observer = nullptr;
    const std::vector<EmissionBlock> blocks = trace_blocks(scene, alone, {0, std::min(kPilot, options.paths)},
                                                           Collector(scene, alone, {guide, 1}, never, never), context);
    // Without the one that found most: an outlier would raise the bound that is to cut it off.
    const auto most = std::ranges::max_element(blocks, {}, [](const EmissionBlock& b) { return b.weights.known(); });
    EmissionBlock sum;
    for (auto b = blocks.begin(); b != blocks.end(); ++b)
        if (b != most || blocks.size() == 1) sum.learn(*b);
    sum.arrivals = 0;
    return sum;
}

/// Traces and stores all light paths. `learnt`: of the first ones.
Emission trace_and_store(const Scene& scene, const EmissionGuide& guide, const EmissionOptions& options,
                         EmissionBlock learnt, MapStores& stores, const RunContext& context) {
    Emission out;
    const std::int64_t known = std::min(kPilot, options.paths); // paths that `learnt` is about
    // In rounds, so that buffers stay small beside the stores, and thresholds follow what is stored.
    const std::int64_t round =
        std::clamp<std::int64_t>(static_cast<std::int64_t>(options.photons) / 32 / kPathsOfBlock, 4, 512) *
        kPathsOfBlock;
    const ProgressStage progress(context, "photons", options.paths, "light paths");
    while (out.paths < options.paths && !(context.stopped() && out.paths > 0)) {
        const Range range{out.paths, std::min(options.paths, out.paths + round)};
        const PhotonWeighing weighing{guide, learnt.weights.unknown_scale(),
                                      options.cut_outliers
                                          ? most_visible(learnt.weights, known + out.paths, options.paths)
                                          : std::numeric_limits<double>::infinity()};
        const Collector collector(scene, options, weighing, stores.thresholds(PhotonRole::pilot),
                                  stores.thresholds(PhotonRole::main_photon));
        for (EmissionBlock& b : trace_blocks(scene, options, range, collector, context)) {
            stores.absorb(PhotonRole::pilot, b.pilots);
            stores.absorb(PhotonRole::main_photon, b.main_photons);
            learnt.learn(b);
        }
        out.paths = range.end;
        context.advance(range.size());
    }
    out.arrivals = learnt.arrivals;
    if (learnt.weights.known() > 0) out.cut = learnt.cut / learnt.weights.known();
    return out;
}

} // namespace

double Emission::scale() const { return emission_scale(paths - paths / kPilotEvery); }

double share_of_photons_seen(const Scene& scene, const EmissionGuide& guide, const StorageRule& rule,
                             std::int64_t paths, std::uint64_t seed, const RunContext& context) {
    if (scene.emitter_distribution().empty()) return 0;
    const EmissionOptions options{.paths = std::min(kPilot, paths), .photons = 0, .rule = rule, .seed = seed};
    return learn_from_pilot(scene, guide, options, context).weights.share_seen(options.paths);
}

EmittedPhotons emit_photons(const Scene& scene, const EmissionGuide& guide, const EmissionOptions& options,
                            const RunContext& context) {
    EmittedPhotons out;
    if (scene.emitter_distribution().empty()) return out;
    EmissionBlock learnt = learn_from_pilot(scene, guide, options, context);
    const std::size_t for_caustic = options.rule.caustics ? learnt.weights.for_caustic(options.photons) : 0;
    MapStores stores({options.photons - for_caustic, for_caustic}, unit_of_power(scene), {}, options.seed);
    static_cast<Emission&>(out) = trace_and_store(scene, guide, options, std::move(learnt), stores, context);
    out.bytes = stores.bytes_held();
    static_cast<Photons&>(out) = stores.release(out.scale(), out.scale());
    return out;
}

Emission emit_photons(const Scene& scene, const EmissionGuide& guide, const EmissionOptions& options, MapStores& stores,
                      const RunContext& context) {
    if (scene.emitter_distribution().empty()) return {};
    return trace_and_store(scene, guide, options, learn_from_pilot(scene, guide, options, context), stores, context);
}

} // namespace keyhole
