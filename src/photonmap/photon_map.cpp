#include "photonmap/photon_map.h"

#include "core/facet.h"

#include <nanoflann.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace keyhole {
namespace {

/// The interface that nanoflann reads points through.
struct PhotonPoints {
    std::span<Photon> photons;

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
void permute(std::span<Photon> photons, std::vector<std::uint32_t>& order) {
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

/// Whether normals of the facet can be accepted by a region of normal `n`. A facet's normals are up to 54.8 degrees
/// from its axis, and accepted ones up to 25.9 degrees from n.
bool facet_faces(std::size_t facet, const Vec3& n) {
    constexpr float kCosine = 0.16f; // of 80.8 degrees
    const auto axis = static_cast<int>(facet % 3);
    return (facet < 3 ? n[axis] : -n[axis]) > kCosine;
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

/// What nanoflann's result sets have in common: trees count their photons from 0, the map all of them.
class InFacet {
  public:
    explicit InFacet(const Photon* photons) : photons_(photons) {}
    void begin(std::uint32_t first) { first_ = first; }

  protected:
    std::uint32_t index_in_map(std::uint32_t index) const { return first_ + index; }
    const Photon& at(std::uint32_t index) const { return photons_[first_ + index]; }

  private:
    const Photon* photons_;
    std::uint32_t first_ = 0;
};

/// nanoflann's result set: offers every photon that is near enough in Euclidean distance, which bounds the region's own
/// from below.
class NearestInRegion : public InFacet {
  public:
    NearestInRegion(const PhotonQuery& query, const Photon* photons, std::vector<Neighbour>& heap)
        : InFacet(photons), region_(query.region), heap_(heap), k_(static_cast<std::size_t>(query.k)) {
        set_bound(query.max_radius * query.max_radius);
    }

    bool full() const { return heap_.size() == k_; }
    /// nanoflann asks for distances strictly below this; equal ones must come too, to be decided by their index.
    float worstDist() const { return above_bound_; }

    bool addPoint(float /*euclidean2*/, std::uint32_t index) {
        const Photon& photon = at(index);
        const Neighbour candidate{region_.distance2(photon.position()), index_in_map(index)};
        if (candidate.distance2 > bound_ || !region_.accepts(photon.normal().unnormalised())) return true;
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
    std::vector<Neighbour>& heap_;
    std::size_t k_;
    float bound_ = 0, above_bound_ = 0;
};

/// nanoflann's result set for one photon that is accepted; asks only about those that are nearer than the best so far.
class NearestAccepted : public InFacet {
  public:
    NearestAccepted(const PhotonQuery& query, const Photon* photons, const std::function<bool(const Photon&)>& accept)
        : InFacet(photons), region_(query.region),
          accept_(accept), best_{query.max_radius * query.max_radius, std::numeric_limits<std::uint32_t>::max()} {}

    bool full() const { return true; }
    float worstDist() const { return std::nextafter(best_.distance2, std::numeric_limits<float>::infinity()); }

    bool addPoint(float /*euclidean2*/, std::uint32_t index) {
        const Photon& photon = at(index);
        const Neighbour candidate{region_.distance2(photon.position()), index_in_map(index)};
        if (candidate < best_ && region_.accepts(photon.normal().unnormalised()) && accept_(photon)) {
            best_ = candidate;
            found_ = &photon;
        }
        return true;
    }

    const Photon* found() const { return found_; }

  private:
    const SurfaceRegion& region_;
    const std::function<bool(const Photon&)>& accept_;
    Neighbour best_;
    const Photon* found_ = nullptr;
};

/// nanoflann's result set: every photon of a region.
class AllInRegion : public InFacet {
  public:
    AllInRegion(const SurfaceRegion& region, float radius, const Photon* photons, std::vector<std::uint32_t>& found)
        : InFacet(photons), region_(region), found_(found), radius2_(radius * radius) {}

    bool full() const { return true; }
    float worstDist() const { return std::nextafter(radius2_, std::numeric_limits<float>::infinity()); }

    bool addPoint(float /*euclidean2*/, std::uint32_t index) {
        const Photon& photon = at(index);
        if (region_.distance2(photon.position()) <= radius2_ && region_.accepts(photon.normal().unnormalised()))
            found_.push_back(index_in_map(index));
        return true;
    }

  private:
    const SurfaceRegion& region_;
    std::vector<std::uint32_t>& found_;
    float radius2_;
};

} // namespace

/// A tree for each facet, so that the photons of the other side of a sheet, or of the walls of a corner, aren't even
/// looked at: beside the thin slats of a lampshade they are a hundred times as many as those asked for.
struct PhotonMap::Index {
    struct Facet {
        explicit Facet(std::span<Photon> part)
            : points{part}, tree(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize)) {
            permute(points.photons, tree.vAcc);
        }
        PhotonPoints points;
        Tree tree;
    };

    explicit Index(std::vector<Photon> all) : photons(std::move(all)) {
        const auto key = [](const Photon& p) { return facet_of(p.normal().unnormalised()); };
        std::ranges::sort(photons, {}, key);
        auto first = photons.begin();
        for (std::size_t facet = 0; facet < facets.size(); ++facet) {
            const auto last = std::ranges::upper_bound(first, photons.end(), facet, {}, key);
            if (first != last) facets[facet] = std::make_unique<Facet>(std::span(first, last));
            first = last;
        }
    }

    /// Offers the photons that the region may accept to a result set of nanoflann's kind.
    template <class Result> void search(const SurfaceRegion& region, Result& result) const {
        for (std::size_t facet = 0; facet < facets.size(); ++facet) {
            if (facets[facet] == nullptr || !facet_faces(facet, region.normal)) continue;
            result.begin(static_cast<std::uint32_t>(facets[facet]->points.photons.data() - photons.data()));
            facets[facet]->tree.findNeighbors(result, region.position.getValue(), {});
        }
    }

    std::vector<Photon> photons;
    std::array<std::unique_ptr<Facet>, 6> facets;
};

PhotonMap::PhotonMap(std::vector<Photon> photons) : index_(std::make_unique<Index>(std::move(photons))) {}
PhotonMap::~PhotonMap() = default;
PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap& PhotonMap::operator=(PhotonMap&&) noexcept = default;

std::span<const Photon> PhotonMap::photons() const { return index_->photons; }

std::size_t PhotonMap::bytes() const {
    std::size_t sum = index_->photons.capacity() * sizeof(Photon);
    for (const auto& facet : index_->facets)
        if (facet != nullptr) sum += facet->tree.usedMemory(facet->tree);
    return sum;
}

const Photon* PhotonMap::nearest_accepted(const PhotonQuery& query,
                                          const std::function<bool(const Photon&)>& accept) const {
    NearestAccepted result(query, photons().data(), accept);
    index_->search(query.region, result);
    return result.found();
}

std::span<const std::uint32_t> PhotonMap::within(const SurfaceRegion& region, float radius) const {
    thread_local std::vector<std::uint32_t> found;
    found.clear();
    AllInRegion result(region, radius, photons().data(), found);
    index_->search(region, result);
    return found;
}

Neighbourhood PhotonMap::nearest(const PhotonQuery& query) const {
    assert(query.k > 0 && std::isfinite(query.max_radius));
    thread_local std::vector<Neighbour> heap;
    heap.clear();
    heap.reserve(static_cast<std::size_t>(query.k));
    NearestInRegion result(query, photons().data(), heap);
    index_->search(query.region, result);
    const float radius2 = result.full() ? heap.front().distance2 : query.max_radius * query.max_radius;
    return {heap, result.full(), radius2};
}

} // namespace keyhole
