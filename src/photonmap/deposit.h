// From sampled paths to photons.
#pragma once

#include "core/choices.h"
#include "core/statistics.h"
#include "photonmap/importance/importance_map.h"
#include "photonmap/map_stores.h"
#include "photonmap/photon_weighing.h"
#include "photonmap/photons.h"
#include "photonmap/power.h"
#include "sampling/paths/path_set.h"
#include "scene/scene.h"

namespace keyhole {

/// What the power of photons is computed from. The caustic map's photons are `marginal` under every rule: from d1 there
/// is one edge to the eye and nothing to draw. With a pinhole camera what is seen straight is known exactly, and the
/// map is asked for the ways by specular vertices alone: at d1 there may be few importons, or a narrow strip of them.
struct DepositOptions {
    const ImportanceMap* global = nullptr;  ///< at d2; null under `reciprocal`
    const ImportanceMap* caustic = nullptr; ///< at d1
    PowerRule rule = PowerRule::marginal;
    const Scene* scene = nullptr;              ///< that camera sub-paths are drawn in; must be given
    PathSet set{};                             ///< that the paths are of, evaluated for it
    int max_scatterings = 24;                  ///< of a whole path
    PhotonRole role = PhotonRole::main_photon; ///< a pilot photon's power is never asked for
    const TechniqueWeights* weights = nullptr; ///< where light tracing makes photons of the same map; null: it doesn't
    PhotonObserver* observer = nullptr;        ///< null: nobody watches
};

/// Collects the photons of one chain: under `marginal` power f_map / Y(f_map E) for each path, times its weight. Times
/// B/N this makes the sum of power over a region the flux that arrives there. Not thread-safe: one for each chain.
class PathDepositor {
  public:
    /// Photons go to `buffers`, which must outlive this.
    PathDepositor(const DepositOptions& options, const Rng& rng, MapBuffers& buffers)
        : options_(options), rng_(rng), unit_(unit_of_power(*options.scene)), buffers_(&buffers) {}

    /// Weights below these, those of the stores that the buffers go to, are sent through the roulette at once: what
    /// doesn't survive costs nothing more.
    void set_thresholds(const MapStores::Thresholds& thresholds) { thresholds_ = thresholds; }

    /// Adds `weight` of `path`. Paths that share a stored sub-path and come close together make one photon: a chain's
    /// state and its candidates take turns, and proposals that change the camera sub-path alone keep it.
    void deposit(const Path& path, double weight);

    /// Stores what is still held back. To be called at the end.
    void flush();

    PhotonRole role() const { return options_.role; }

    /// What came of the deposits, for statistics and for scales.
    struct Tally {
        double total = 0;            ///< weight of all
        double lost = 0;             ///< weight of those whose importance came out as zero: power that the maps lack
        double visible = 0;          ///< under `literal`: sum of Y(Phi E) over the global photons, whose weight is...
        double visible_weight = 0;   ///< ... this: their ratio is the scale that the rule leaves open
        RunningStats power;          ///< luminance of the global photons' power for weight 1
        RunningStats literal_power;  ///< what MPS 3.2 would have given the same photons
        std::uint64_t draws = 0;     ///< camera sub-paths drawn
        std::uint64_t untrusted = 0; ///< photons for which `marginal` turned to `reciprocal`

        void merge(const Tally& o);
    };
    const Tally& tally() const { return tally_; }

  private:
    /// A stored sub-path that may still gain weight.
    struct Pending {
        PhotonKind kind = PhotonKind::none;
        Vertex vertex;
        Vec3 to_light;
        Rgb flux;             ///< f_map up to its scale, which cancels
        int scatterings = 0;  ///< of the stored sub-path, its end included
        bool caustic = false; ///< see Photon
        double share = 1;     ///< of chains, in photons here
        double weight = 0;
        double literal = 0;              ///< sum of weight times literal_factor()
        double density = 0;              ///< sum of weight times literal_factor() times camera_subpath_density()
        std::vector<TrailPoint> trail{}; ///< the path that it was first met on, where somebody watches
        std::uint32_t emitter = SurfacePoint::kNone;

        void watch(const Path& path);
        bool holds(const Path& path, const StoragePoint& at, const Rgb& its_flux) const;
    };

    void store(Pending& pending);
    // Power for weight 1; black where it is lost. `given` is the weight that the sums of `pending` are over.
    Rgb power_of(const Pending& pending, bool global, double given, double weight);
    Rgb global_power(const Pending& pending, double given, double weight);
    Rgb caustic_power(const Pending& pending) const;
    /// By ways to the eye that a path of the stored sub-path may take.
    ImportanceMap::Importance importance(const Pending& pending, const ImportanceMap& map,
                                         Ways ways = Ways::all) const {
        const PhotonKind kind = &map == options_.global ? PhotonKind::global : PhotonKind::caustic;
        return map.importance(pending.vertex.point, pending.vertex.bsdf, pending.to_light, ways,
                              spare_scatterings(kind, pending.scatterings, options_.max_scatterings));
    }
    /// E of the straight edge from d1 to a pinhole; 0 where it is hidden.
    Rgb straight_importance(const Pending& pending) const;
    Rgb by_drawing(const Pending& pending, double given);
    Rgb to_the_letter(const Pending& pending, double given, double weight);

    DepositOptions options_;
    Rng rng_;
    MapStores::Thresholds thresholds_;
    double unit_; // of power
    MapBuffers* buffers_;
    Pending recent_, older_;
    Tally tally_;
};

} // namespace keyhole
