// From sampled paths to photons.
#pragma once

#include "photonmap/importance_map.h"
#include "photonmap/photon_store.h"
#include "sampling/path.h"

namespace keyhole {

/// The importance of each map's storage points.
struct DepositImportance {
    const ImportanceMap* global;  ///< at d2
    const ImportanceMap* caustic; ///< at d1
};

/// Collects the photons of one chain: power f_map / Y(f_map E) for each path, times its weight (MATHEMATICS:
/// "marginal"). Times B/N this makes the sum of power over a region the flux that arrives there, and gives every photon
/// the same weight where it is asked. Not thread-safe: one for each chain.
class PathDepositor {
  public:
    PathDepositor(const DepositImportance& importance, const Rng& rng) : importance_(importance), rng_(rng) {}

    /// Weights below these, those of the stores that the buffers go to, are sent through the roulette at once: what
    /// doesn't survive costs nothing more.
    void set_thresholds(double global, double caustic) {
        global_threshold_ = global;
        caustic_threshold_ = caustic;
    }

    /// Adds `weight` of `path`. Paths that share a stored sub-path and come close together make one photon: a chain's
    /// state and its candidates take turns, and proposals that change the eye side alone keep it.
    void deposit(const Path& path, double weight);

    /// Stores what is still held back. To be called at the end.
    void flush();

    PhotonBuffer& global() { return global_; }
    PhotonBuffer& caustic() { return caustic_; }

    /// Weight of deposits whose importance was estimated as zero, as a share of all: power that the maps lack.
    double lost_weight() const { return lost_; }
    double total_weight() const { return total_; }

  private:
    /// A stored sub-path that may still gain weight.
    struct Pending {
        PhotonKind kind = PhotonKind::none;
        Vertex vertex;
        Vec3 to_light;
        Rgb flux; ///< f_map up to its scale, which cancels
        double weight = 0;

        bool holds(const Path& path, const StoragePoint& at) const;
    };

    void store(Pending& pending);

    DepositImportance importance_;
    Rng rng_;
    double global_threshold_ = 0, caustic_threshold_ = 0;
    PhotonBuffer global_, caustic_;
    Pending recent_, older_;
    double lost_ = 0, total_ = 0;
};

} // namespace keyhole
