// Photons with an index that finds the nearest ones.
#pragma once

#include "photonmap/photon.h"
#include "photonmap/surface/surface_region.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace keyhole {

struct PhotonQuery {
    SurfaceRegion region;
    float max_radius; ///< [m], finite
    int k;            ///< most photons wanted, > 0
    float shrink = 1; ///< an estimate uses the photons within this share of the radius found, for passes
};

/// A photon found. Ordered by distance, equal distances by index.
struct Neighbour {
    float distance2; ///< SurfaceRegion::distance2
    std::uint32_t index;

    bool operator<(const Neighbour& o) const {
        return distance2 != o.distance2 ? distance2 < o.distance2 : index < o.index;
    }
};

/// The photons of a region, in no order except that the farthest comes first if `full`. Valid until the next query of
/// the same thread.
struct Neighbourhood {
    std::span<const Neighbour> found;
    bool full;     ///< k photons lie within max_radius: the region ends at the farthest; otherwise at max_radius
    float radius2; ///< squared radius of the region [m^2]
};

/// Photons in the order of the leaves of a kd-tree. Thread-safe but for put_out(); the same photons in the same order
/// give the same map.
class PhotonMap {
  public:
    /// What most questions will ask for.
    enum class Wanted { many, one };

    explicit PhotonMap(std::vector<Photon> photons, Wanted wanted = Wanted::many);
    ~PhotonMap();
    PhotonMap(PhotonMap&&) noexcept;
    PhotonMap& operator=(PhotonMap&&) noexcept;

    /// The k nearest photons of the query's region. Photons of other surfaces are turned away inside the search: they
    /// neither count nor narrow it. Allocates nothing after a thread's first query of that k.
    Neighbourhood nearest(const PhotonQuery& query) const;

    /// Visits all photons of the region within `radius` [m], in the order of the tree.
    template <class Visit> void for_each_within(const SurfaceRegion& region, float radius, const Visit& visit) const {
        for (const std::uint32_t i : within(region, radius)) visit((*this)[i]);
    }
    /// The same until `visit` returns true. Returns whether it did.
    template <class Visit> bool any_within(const SurfaceRegion& region, float radius, const Visit& visit) const {
        return std::ranges::any_of(within(region, radius), [&](std::uint32_t i) { return visit((*this)[i]); });
    }

    /// What is to be expected of a search: most find a photon near by, or many find none in all of their region.
    enum class Expected { some, none };

    /// The nearest photon of the region within `max_radius` [m], finite: what nearest() finds for k = 1, several times
    /// as fast. The answer doesn't depend on what is expected.
    std::optional<Neighbour> nearest_one(const SurfaceRegion& region, float max_radius,
                                         Expected expected = Expected::some) const;
    /// The nearest of those that `accept` accepts. It is asked only about photons that are nearer than the best so far.
    std::optional<Neighbour> nearest_accepted(const SurfaceRegion& region, float max_radius,
                                              const std::function<bool(const Photon&)>& accept) const;

    /// Takes a photon's power. Not while others ask.
    void put_out(std::uint32_t i);

    std::span<const Photon> photons() const;
    const Photon& operator[](std::uint32_t i) const { return photons()[i]; }
    /// Memory of photons and index [bytes].
    std::size_t bytes() const;
    /// Of the index, where there are many photons [bytes].
    static double index_bytes_per_photon(Wanted wanted);

  private:
    /// Valid until the next call of the same thread.
    std::span<const std::uint32_t> within(const SurfaceRegion& region, float radius) const;

    struct Index;
    std::unique_ptr<Index> index_;
};

} // namespace keyhole
