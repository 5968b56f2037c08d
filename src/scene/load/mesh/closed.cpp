#include "scene/load/load_mesh.h"

#include <Imath/ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace keyhole {
namespace {

/// Numbers places that are apart. Seams of meshes have their positions twice, alike but for rounding.
class PlaceNumbers {
  public:
    explicit PlaceNumbers(double apart) : apart_(apart) {}

    std::uint32_t number(const Vec3& p) {
        Cell lowest{}, highest{};
        for (int axis = 0; axis < 3; ++axis) {
            lowest[axis] = cell(p[axis] - apart_);
            highest[axis] = cell(p[axis] + apart_);
        }
        for (std::int64_t x = lowest[0]; x <= highest[0]; ++x)
            for (std::int64_t y = lowest[1]; y <= highest[1]; ++y)
                for (std::int64_t z = lowest[2]; z <= highest[2]; ++z)
                    if (const Place* known = find({x, y, z}, p)) return known->number;
        cells_[hash({cell(p.x), cell(p.y), cell(p.z)})].push_back({p, next_});
        return next_++;
    }

  private:
    using Cell = std::array<std::int64_t, 3>;
    struct Place {
        Vec3 p;
        std::uint32_t number;
    };

    std::int64_t cell(double x) const { return static_cast<std::int64_t>(std::floor(x / (8 * apart_))); }
    static std::size_t hash(const Cell& c) {
        std::size_t h = 0;
        for (const std::int64_t x : c) h = (h ^ static_cast<std::size_t>(x)) * 0x9E3779B97F4A7C15u;
        return h ^ h >> 32;
    }
    const Place* find(const Cell& cell, const Vec3& p) const {
        const auto places = cells_.find(hash(cell));
        if (places == cells_.end()) return nullptr;
        for (const Place& place : places->second)
            if ((Imath::V3d(place.p) - Imath::V3d(p)).length() <= apart_) return &place;
        return nullptr;
    }

    double apart_;
    std::uint32_t next_ = 0;
    std::unordered_map<std::size_t, std::vector<Place>> cells_;
};

} // namespace

Imath::Box3d box_of(const TriangleMesh& mesh) {
    Imath::Box3d box;
    for (const Vec3& p : mesh.positions) box.extendBy(Imath::V3d(p));
    return box;
}

bool is_closed(const TriangleMesh& mesh) {
    const Imath::Box3d box = box_of(mesh);
    double farthest = 0;
    for (const Vec3& p : mesh.positions) farthest = std::max(farthest, Imath::V3d(p).length());
    const double apart = std::max(1e-5 * box.size().length(), 5e-7 * farthest);
    if (!(apart > 0)) return false;
    PlaceNumbers numbers(apart);
    std::vector<std::uint32_t> places;
    for (const Vec3& p : mesh.positions) places.push_back(numbers.number(p));
    std::vector<std::array<std::uint32_t, 2>> there, back;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = places[t[k]], b = places[t[(k + 1) % 3]];
            if (a != b) (a < b ? there : back).push_back({std::min(a, b), std::max(a, b)});
        }
    std::ranges::sort(there);
    std::ranges::sort(back);
    return !there.empty() && there == back;
}

} // namespace keyhole
