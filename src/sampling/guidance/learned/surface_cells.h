// Parts of a scene's surfaces that lie and look alike.
#pragma once

#include "core/parallel.h"
#include "core/vec.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace keyhole {

/// A k-d tree over places and normals, split at medians until cells hold few points. Immutable and thread-safe.
class SurfaceCells {
  public:
    struct Place {
        Vec3 p; ///< world space [m]
        Vec3 n; ///< unit normal
    };

    SurfaceCells() = default;
    /// @param least points that each cell holds, unless there are fewer in all
    SurfaceCells(std::vector<Place> points, std::size_t least);

    std::uint32_t size() const { return cells_; }
    /// That of any place, between 0 and size() - 1.
    std::uint32_t cell_of(const Place& place) const;
    std::size_t bytes() const { return nodes_.capacity() * sizeof(Node); }

  private:
    static constexpr int kDimensions = 6;
    struct Node {
        float split = 0;
        std::uint32_t right = 0; ///< the left child follows its parent; of a leaf its cell
        std::int8_t axis = -1;   ///< of a leaf -1
    };
    float coordinate(const Place& place, int axis) const {
        return axis < 3 ? place.p[axis] : normal_scale_ * place.n[axis - 3];
    }
    void build(std::span<Place> points, std::size_t least);
    bool split(std::span<Place> points, std::size_t least, Node& node, std::size_t& left) const;

    float normal_scale_ = 0; // [m]: by how much normals count beside places
    std::vector<Node> nodes_{Node{}};
    std::uint32_t cells_ = 1;
};

/// Cells over all that has a place `at`, and what stands in each of them, in its order.
template <class Seen> struct SeenInCells {
    SurfaceCells tree;
    std::vector<std::vector<const Seen*>> cells;

    /// @param seen must outlive this
    /// @param least of them that each cell holds, unless there are fewer in all
    SeenInCells(std::span<const Seen> seen, std::size_t least) {
        std::vector<SurfaceCells::Place> places;
        places.reserve(seen.size());
        for (const Seen& s : seen) places.push_back(s.at);
        tree = SurfaceCells(std::move(places), least);
        cells.resize(tree.size());
        for (const Seen& s : seen) cells[tree.cell_of(s.at)].push_back(&s);
    }

    /// make(what stands in it) of each cell.
    template <class Make> auto made(const Make& make) const {
        std::vector<decltype(make(cells[0]))> all(cells.size());
        parallel_for(static_cast<std::int64_t>(all.size()), [&](std::int64_t i) {
            all[static_cast<std::size_t>(i)] = make(cells[static_cast<std::size_t>(i)]);
        });
        return all;
    }
};

} // namespace keyhole
