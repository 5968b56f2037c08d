#include "photonmap/photon_map.h"

#include <nanoflann.hpp>

#include <algorithm>
#include <limits>

namespace keyhole {
namespace {

/// The interface that nanoflann reads points through.
struct PhotonPoints {
    std::vector<Photon> photons;

    std::size_t kdtree_get_point_count() const { return photons.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return photons[i].position()[static_cast<int>(axis)]; }
    template <class Box> bool kdtree_get_bbox(Box&) const { return false; }
};

using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PhotonPoints, float, std::uint32_t>,
                                        PhotonPoints, 3, std::uint32_t>;
constexpr std::size_t kLeafSize = 32;

/// Brings photons into the order of the tree's leaves, in place: following the cycles of the permutation, since a
/// second array would double the memory of a map.
void permute(std::vector<Photon>& photons, std::vector<std::uint32_t>& order) {
    for (std::uint32_t start = 0; start < order.size(); ++start) {
        if (order[start] == start) continue;
        const Photon first = photons[start];
        std::uint32_t to = start;
        while (order[to] != start) {
            const std::uint32_t from = order[to];
            photons[to] = photons[from];
            order[to] = to;
            to = from;
        }
        photons[to] = first;
        order[to] = to;
    }
}

/// Replaces the root of a max-heap.
void replace_top(std::vector<Neighbour>& heap, const Neighbour& item) {
    const std::size_t n = heap.size();
    std::size_t hole = 0;
    for (std::size_t child = 1; child < n; child = 2 * hole + 1) {
        if (child + 1 < n && heap[child] < heap[child + 1]) ++child;
        if (!(item < heap[child])) break;
        heap[hole] = heap[child];
        hole = child;
    }
    heap[hole] = item;
}

/// nanoflann's result set: offers every photon that is near enough in Euclidean distance, which bounds the region's own
/// from below.
class NearestInRegion {
  public:
    NearestInRegion(const PhotonQuery& query, const Photon* photons, std::vector<Neighbour>& heap)
        : region_(query.region), photons_(photons), heap_(heap), k_(static_cast<std::size_t>(query.k)) {
        set_bound(query.max_radius * query.max_radius);
    }

    bool full() const { return heap_.size() == k_; }
    /// nanoflann asks for distances strictly below this; equal ones must come too, to be decided by their index.
    float worstDist() const { return above_bound_; }

    bool addPoint(float /*euclidean2*/, std::uint32_t index) {
        const Neighbour candidate{region_.distance2(photons_[index].position()), index};
        if (candidate.distance2 > bound_ || !region_.accepts(photons_[index].normal().unnormalised())) return true;
        if (!full()) {
            heap_.push_back(candidate);
            if (full()) std::make_heap(heap_.begin(), heap_.end());
        } else if (candidate < heap_.front()) {
            replace_top(heap_, candidate);
        }
        if (full()) set_bound(heap_.front().distance2);
        return true;
    }

  private:
    void set_bound(float distance2) {
        bound_ = distance2;
        above_bound_ = std::nextafter(distance2, std::numeric_limits<float>::infinity());
    }

    const SurfaceRegion& region_;
    const Photon* photons_;
    std::vector<Neighbour>& heap_;
    std::size_t k_;
    float bound_ = 0, above_bound_ = 0;
};

/// nanoflann's result set for one photon that is accepted; asks only about those that are nearer than the best so far.
class NearestAccepted {
  public:
    NearestAccepted(const PhotonQuery& query, const Photon* photons, const std::function<bool(const Photon&)>& accept)
        : region_(query.region), photons_(photons),
          accept_(accept), best_{query.max_radius * query.max_radius, std::numeric_limits<std::uint32_t>::max()} {}

    bool full() const { return true; }
    float worstDist() const { return std::nextafter(best_.distance2, std::numeric_limits<float>::infinity()); }

    bool addPoint(float /*euclidean2*/, std::uint32_t index) {
        const Photon& photon = photons_[index];
        const Neighbour candidate{region_.distance2(photon.position()), index};
        if (candidate < best_ && region_.accepts(photon.normal().unnormalised()) && accept_(photon)) {
            best_ = candidate;
            found_ = &photon;
        }
        return true;
    }

    const Photon* found() const { return found_; }

  private:
    const SurfaceRegion& region_;
    const Photon* photons_;
    const std::function<bool(const Photon&)>& accept_;
    Neighbour best_;
    const Photon* found_ = nullptr;
};

/// nanoflann's result set: every photon of a region.
class AllInRegion {
  public:
    AllInRegion(const SurfaceRegion& region, float radius, const Photon* photons, std::vector<std::uint32_t>& found)
        : region_(region), photons_(photons), found_(found), radius2_(radius * radius) {}

    bool full() const { return true; }
    float worstDist() const { return std::nextafter(radius2_, std::numeric_limits<float>::infinity()); }

    bool addPoint(float /*euclidean2*/, std::uint32_t index) {
        const Photon& photon = photons_[index];
        if (region_.distance2(photon.position()) <= radius2_ && region_.accepts(photon.normal().unnormalised()))
            found_.push_back(index);
        return true;
    }

  private:
    const SurfaceRegion& region_;
    const Photon* photons_;
    std::vector<std::uint32_t>& found_;
    float radius2_;
};

} // namespace

struct PhotonMap::Index {
    explicit Index(std::vector<Photon> photons)
        : points{std::move(photons)}, tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {
        permute(points.photons, tree.vAcc);
    }

    PhotonPoints points;
    Tree tree;
};

PhotonMap::PhotonMap(std::vector<Photon> photons) : index_(std::make_unique<Index>(std::move(photons))) {}
PhotonMap::~PhotonMap() = default;
PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap& PhotonMap::operator=(PhotonMap&&) noexcept = default;

std::span<const Photon> PhotonMap::photons() const { return index_->points.photons; }

std::size_t PhotonMap::bytes() const {
    return index_->points.photons.capacity() * sizeof(Photon) + index_->tree.usedMemory(index_->tree);
}

const Photon* PhotonMap::nearest_accepted(const PhotonQuery& query,
                                          const std::function<bool(const Photon&)>& accept) const {
    if (photons().empty()) return nullptr;
    NearestAccepted result(query, photons().data(), accept);
    index_->tree.findNeighbors(result, query.region.position.getValue(), {});
    return result.found();
}

std::span<const std::uint32_t> PhotonMap::within(const SurfaceRegion& region, float radius) const {
    thread_local std::vector<std::uint32_t> found;
    found.clear();
    AllInRegion result(region, radius, photons().data(), found);
    if (!photons().empty()) index_->tree.findNeighbors(result, region.position.getValue(), {});
    return found;
}

Neighbourhood PhotonMap::nearest(const PhotonQuery& query) const {
    assert(query.k > 0 && std::isfinite(query.max_radius));
    thread_local std::vector<Neighbour> heap;
    heap.clear();
    heap.reserve(static_cast<std::size_t>(query.k));
    NearestInRegion result(query, photons().data(), heap);
    if (!photons().empty()) index_->tree.findNeighbors(result, query.region.position.getValue(), {});
    const float radius2 = result.full() ? heap.front().distance2 : query.max_radius * query.max_radius;
    return {heap, result.full(), radius2};
}

} // namespace keyhole
