// Keeps what a page shows of the photons of a pass: a sample of them, and the paths that brought them.
#pragma once

#include "methods/photons/pass_observer.h"

#include <array>
#include <compare>
#include <map>
#include <mutex>

namespace keyhole {

/// A main photon of a map.
struct PhotonShown {
    Photon photon;
    bool caustic;                                ///< of the caustic map, else of the global one
    bool guided = false;                         ///< whether its path began along a user path
    int scatterings = -1;                        ///< before it arrived; -1: the sampler doesn't say
    std::uint32_t emitter = SurfacePoint::kNone; ///< that it comes from, where that is known
    bool gathered = true;                        ///< whether gather rays come there
    std::int32_t trail = -1;                     ///< index among the trails, where its whole path was kept
};

/// A whole path from the emitter on, which goes on to the eye where the sampler has such paths.
struct PhotonTrail {
    std::vector<TrailPoint> points;
    std::size_t photon = 0; ///< index of the point that the photon lies at

    bool operator==(const PhotonTrail&) const = default;
};

struct PhotonSample {
    struct Map {
        std::size_t main_photons = 0, pilots = 0;
        double power = 0; ///< luminous, of the main photons [W]
    };
    Map global, caustic;
    std::vector<PhotonShown> photons; ///< each stands for as many of its map as there are for one shown
    std::vector<PhotonTrail> trails;
    std::uint64_t refused = 0;    ///< arrivals that did not survive the roulette of the stores
    std::vector<Vec3> refused_at; ///< where, of some of these
};

/// The same on any number of threads: what is kept follows from the photons' places.
class PhotonRecorder {
  public:
    void stored(const Photon& photon, const PhotonOrigin& origin);
    void thrown_away(const Vec3& p);

    /// Of the photons that are left in the maps, at most `photons` with at most `trails` paths.
    PhotonSample sample(const Photons& maps, std::size_t photons, std::size_t trails);

  private:
    /// Where a photon lies and where its light came from, bit by bit: no two have the same.
    using Key = std::array<std::uint32_t, 6>;
    struct Origin {
        int scatterings = 0;
        std::uint32_t emitter = 0;
        bool guided = false;
        PhotonTrail trail{}; ///< empty: not kept

        bool comes_before(const Origin& o) const;
    };
    struct Shard {
        std::mutex mutex;
        std::map<Key, Origin> origins;
        std::map<std::array<float, 3>, int> refused_at;
        std::uint64_t refused = 0;
    };
    static Key key_of(const Photon& photon);
    static std::uint64_t hash(const Key& key);
    void add(std::span<const Photon> photons, std::size_t most, bool caustic, PhotonSample& out);
    const Origin* origin_of(const Photon& photon);

    static constexpr std::size_t kShards = 64;
    static constexpr std::uint64_t kTrailsEvery = 3; ///< photons of which one has its whole path kept
    static constexpr std::uint64_t kRefusedEvery = 16;
    std::array<Shard, kShards> shards_;
};

} // namespace keyhole
