#include "photonmap/photon_map.h"

#include "core/vec.h"
#include "photonmap/kd_tree.h"

#include <algorithm>
#include <array>
#include <limits>

namespace keyhole {
namespace {

/// Photons in a leaf: many where many are wanted at a time, few where one is.
constexpr std::uint32_t leaf_size(PhotonMap::Wanted wanted) { return wanted == PhotonMap::Wanted::many ? 32 : 8; }

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

/// The nearest of a region.
class NearestInRegion {
  public:
    static constexpr bool kFlat = false;

    NearestInRegion(const PhotonQuery& query, const Photon* photons, std::vector<Neighbour>& heap)
        : region_(query.region), photons_(photons), heap_(heap), k_(static_cast<std::size_t>(query.k)),
          bound_(query.max_radius * query.max_radius) {}

    bool full() const { return heap_.size() == k_; }
    float bound() const { return bound_; }

    void offer(std::uint32_t index) {
        const Photon& photon = photons_[index];
        const Neighbour candidate{region_.distance2(photon.position()), index};
        if (candidate.distance2 > bound_ || !region_.accepts(photon.normal().unnormalised())) return;
        if (!full()) {
            heap_.push_back(candidate);
            if (full()) std::make_heap(heap_.begin(), heap_.end());
        } else if (candidate < heap_.front()) {
            replace_top(heap_, candidate);
        }
        if (full()) bound_ = heap_.front().distance2;
    }

  private:
    const SurfaceRegion& region_;
    const Photon* photons_;
    std::vector<Neighbour>& heap_;
    std::size_t k_;
    float bound_;
};

/// The nearest photon that is accepted; asks only about those that are nearer than the best so far. With one photon
/// wanted there is no heap to be kept.
template <class Accept, PhotonMap::Expected expected> class NearestOne {
  public:
    static constexpr bool kFlat = expected == PhotonMap::Expected::none;

    NearestOne(const SurfaceRegion& region, float max_radius, const Photon* photons, const Accept& accept)
        : region_(region), photons_(photons),
          accept_(accept), best_{max_radius * max_radius, std::numeric_limits<std::uint32_t>::max()} {}

    float bound() const { return best_.distance2; }

    void offer(std::uint32_t index) {
        const Photon& photon = photons_[index];
        const Neighbour candidate{region_.distance2(photon.position()), index};
        if (!(candidate < best_) || !region_.accepts(photon.normal().unnormalised()) || !accept_(photon)) return;
        best_ = candidate;
        any_ = true;
    }

    std::optional<Neighbour> found() const { return any_ ? std::optional(best_) : std::nullopt; }

  private:
    const SurfaceRegion& region_;
    const Photon* photons_;
    const Accept& accept_;
    Neighbour best_;
    bool any_ = false;
};

/// Every photon of a region.
class AllInRegion {
  public:
    static constexpr bool kFlat = false;

    AllInRegion(const SurfaceRegion& region, float radius, const Photon* photons, std::vector<std::uint32_t>& found)
        : region_(region), photons_(photons), found_(found), radius2_(radius * radius) {}

    float bound() const { return radius2_; }

    void offer(std::uint32_t index) {
        const Photon& photon = photons_[index];
        if (region_.distance2(photon.position()) <= radius2_ && region_.accepts(photon.normal().unnormalised()))
            found_.push_back(index);
    }

  private:
    const SurfaceRegion& region_;
    const Photon* photons_;
    std::vector<std::uint32_t>& found_;
    float radius2_;
};

} // namespace

/// A tree for each facet, so that the photons of the other side of a sheet, or of the walls of a corner, aren't even
/// looked at: beside the thin slats of a lampshade they are a hundred times as many as those asked for.
struct PhotonMap::Index {
    Index(std::vector<Photon> all, std::uint32_t leaf) : photons(std::move(all)) {
        const auto key = [](const Photon& p) { return facet_of(p.normal().unnormalised()); };
        std::ranges::sort(photons, {}, key);
        const auto begin = photons.begin();
        auto first = begin;
        for (std::size_t facet = 0; facet < facets.size(); ++facet) {
            const auto last = std::ranges::upper_bound(first, photons.end(), facet, {}, key);
            facets[facet] = KdTree(photons, static_cast<std::uint32_t>(first - begin),
                                   static_cast<std::uint32_t>(last - begin), leaf);
            first = last;
        }
    }

    /// Offers the photons that the region may accept.
    template <class Result> void search(const SurfaceRegion& region, Result& result) const {
        for (std::size_t facet = 0; facet < facets.size(); ++facet)
            if (facet_faces(facet, region.normal)) facets[facet].search(region, result);
    }

    template <Expected expected, class Accept>
    std::optional<Neighbour> nearest_one(const SurfaceRegion& region, float max_radius, const Accept& accept) const {
        NearestOne<Accept, expected> result(region, max_radius, photons.data(), accept);
        search(region, result);
        return result.found();
    }

    std::vector<Photon> photons;
    std::array<KdTree, 6> facets;
};

PhotonMap::PhotonMap(std::vector<Photon> photons, Wanted wanted)
    : index_(std::make_unique<Index>(std::move(photons), leaf_size(wanted))) {}
PhotonMap::~PhotonMap() = default;
PhotonMap::PhotonMap(PhotonMap&&) noexcept = default;
PhotonMap& PhotonMap::operator=(PhotonMap&&) noexcept = default;

std::span<const Photon> PhotonMap::photons() const { return index_->photons; }

std::size_t PhotonMap::bytes() const {
    std::size_t sum = index_->photons.capacity() * sizeof(Photon);
    for (const KdTree& facet : index_->facets) sum += facet.bytes();
    return sum;
}

double PhotonMap::index_bytes_per_photon(Wanted wanted) { return KdTree::bytes_per_photon(leaf_size(wanted)); }

std::optional<Neighbour> PhotonMap::nearest_one(const SurfaceRegion& region, float max_radius,
                                                Expected expected) const {
    const auto any = [](const Photon&) { return true; };
    return expected == Expected::none ? index_->nearest_one<Expected::none>(region, max_radius, any)
                                      : index_->nearest_one<Expected::some>(region, max_radius, any);
}

std::optional<Neighbour> PhotonMap::nearest_accepted(const SurfaceRegion& region, float max_radius,
                                                     const std::function<bool(const Photon&)>& accept) const {
    return index_->nearest_one<Expected::none>(region, max_radius, accept);
}

std::span<const std::uint32_t> PhotonMap::within(const SurfaceRegion& region, float radius) const {
    thread_local std::vector<std::uint32_t> found;
    found.clear();
    AllInRegion result(region, radius, photons().data(), found);
    index_->search(region, result);
    return found;
}

void PhotonMap::put_out(std::uint32_t i) { index_->photons[i].set_power(Rgb(0.0)); }

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
