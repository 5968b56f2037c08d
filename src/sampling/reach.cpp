#include "sampling/reach.h"

#include "core/facet.h"
#include "core/parallel.h"
#include "sampling/eye_path_head.h"
#include "sampling/image_lattice.h"
#include "sampling/light_tracer.h"

#include <algorithm>
#include <array>

namespace keyhole {
namespace {

constexpr std::int64_t kBlocks = 64;
constexpr std::uint64_t kSeed = 1; // the reach doesn't change with the seed: passes and their shares are to agree on it

/// How many rays come near the typical ray's end at least; cells grow until they do.
constexpr int kTypical = 32;
/// Rays come to a place if they are as dense there as this share of what is typical.
constexpr double kLeast = 1.0 / 32;

constexpr float kFinest = 0.01f, kCoarsest = 0.08f; // cells, in parts of the scene's size
constexpr int kBits = 20;                           // of a cell's coordinate

/// Where a gather ray asks.
struct Place {
    Vec3 p, n;
};

std::vector<Place> trace_places(const Scene& scene, int max_scatterings, std::int64_t paths) {
    std::vector<std::vector<Place>> parts(kBlocks);
    parallel_for(kBlocks, [&](std::int64_t b) {
        const Range range = split(paths, kBlocks, b);
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            Rng rng(kSeed, StreamPurpose::reach, static_cast<std::uint64_t>(i));
            trace_eye_path_head(
                scene, lattice_image_point(kSeed, StreamPurpose::reach, i), max_scatterings, rng,
                [&](const Vertex& v, const Vec3& to_eye, const Rgb&, int finite) {
                    if (finite == 1)
                        parts[static_cast<std::size_t>(b)].push_back({v.point.p, facing(v.point.ng, to_eye)});
                });
        }
    });
    std::vector<Place> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::uint64_t key(const std::array<std::int64_t, 3>& c, std::uint64_t facet) {
    std::uint64_t key = facet;
    for (const std::int64_t i : c)
        key = key << kBits | static_cast<std::uint64_t>(std::clamp<std::int64_t>(i, 0, (1 << kBits) - 1));
    return key;
}

struct Count {
    std::uint64_t cell;
    int rays;
};

/// Adds up what is said of the same cell; sorts by cell.
void merge(std::vector<Count>& counts) {
    std::sort(counts.begin(), counts.end(), [](const Count& a, const Count& b) { return a.cell < b.cell; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (kept > 0 && counts[kept - 1].cell == counts[i].cell)
            counts[kept - 1].rays += counts[i].rays;
        else
            counts[kept++] = counts[i];
    }
    counts.resize(kept);
}

/// For each cell, the rays that come to it and to those around it.
std::vector<Count> count_around(const std::vector<Count>& in_cells) {
    constexpr std::uint64_t mask = (1 << kBits) - 1;
    std::vector<Count> around;
    around.reserve(27 * in_cells.size());
    for (const Count& c : in_cells) {
        const auto x = static_cast<std::int64_t>(c.cell >> 2 * kBits & mask),
                   y = static_cast<std::int64_t>(c.cell >> kBits & mask), z = static_cast<std::int64_t>(c.cell & mask);
        for (std::int64_t i = x - 1; i <= x + 1; ++i)
            for (std::int64_t j = y - 1; j <= y + 1; ++j)
                for (std::int64_t k = z - 1; k <= z + 1; ++k)
                    around.push_back({key({i, j, k}, c.cell >> 3 * kBits), c.rays});
    }
    merge(around);
    return around;
}

int find(const std::vector<Count>& counts, std::uint64_t cell) {
    const auto at = std::lower_bound(counts.begin(), counts.end(), cell,
                                     [](const Count& c, std::uint64_t wanted) { return c.cell < wanted; });
    return at != counts.end() && at->cell == cell ? at->rays : 0;
}

/// Rays around the median ray's end.
int typical_count(const std::vector<Count>& in_cells, const std::vector<Count>& around) {
    std::vector<Count> ends;
    std::int64_t rays = 0;
    for (const Count& c : in_cells) {
        ends.push_back({static_cast<std::uint64_t>(find(around, c.cell)), c.rays});
        rays += c.rays;
    }
    std::sort(ends.begin(), ends.end(), [](const Count& a, const Count& b) { return a.cell < b.cell; });
    for (std::int64_t before = 0; const Count& e : ends)
        if ((before += e.rays) >= rays / 2) return static_cast<int>(e.cell);
    return 0;
}

} // namespace

Reach::Reach(const Scene& scene, int max_scatterings, std::int64_t paths) : origin_(scene.lower()) {
    const std::vector<Place> places = trace_places(scene, max_scatterings, paths);
    const float extent = (scene.upper() - scene.lower()).length();
    for (size_ = kFinest * extent; size_ > 0; size_ *= 2) {
        std::vector<Count> counts;
        counts.reserve(places.size());
        for (const Place& place : places) counts.push_back({cell(place.p, place.n), 1});
        merge(counts);
        const std::vector<Count> around = count_around(counts);
        const int typical = typical_count(counts, around);
        if (typical < kTypical && 2 * size_ <= kCoarsest * extent) continue;
        for (const Count& c : around)
            if (c.rays >= kLeast * typical) cells_.push_back(c.cell);
        break;
    }
    cells_.shrink_to_fit();
}

std::uint64_t Reach::cell(const Vec3& p, const Vec3& n) const {
    const Vec3 at = (p - origin_) / size_;
    // One free cell all around, so that no neighbour falls off the edge.
    return key(
        {static_cast<std::int64_t>(at.x) + 1, static_cast<std::int64_t>(at.y) + 1, static_cast<std::int64_t>(at.z) + 1},
        facet_of(n));
}

bool Reach::comes_to(const Vec3& p, const Vec3& n) const {
    return std::binary_search(cells_.begin(), cells_.end(), cell(p, n));
}

double light_beyond_reach(const Scene& scene, const Reach& reach, int max_scatterings, std::int64_t paths) {
    struct Sink {
        const Reach& reach;
        double all = 0, beyond = 0;

        bool arrival(const Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast& past) {
            if (!past.last || !v.bsdf.traits().finite) return true;
            all += luminance(power);
            if (!reach.comes_to(v.point.p, facing(v.point.ng, to_light))) beyond += luminance(power);
            return true;
        }
    };
    std::vector<Sink> sinks(kBlocks, Sink{reach});
    parallel_for(kBlocks, [&](std::int64_t b) {
        const Range range = split(paths, kBlocks, b);
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            Rng rng(kSeed, StreamPurpose::reach_light, static_cast<std::uint64_t>(i));
            trace_light_path(scene, max_scatterings, rng, sinks[static_cast<std::size_t>(b)]);
        }
    });
    double all = 0, beyond = 0;
    for (const Sink& sink : sinks) {
        all += sink.all;
        beyond += sink.beyond;
    }
    return all > 0 ? beyond / all : 0.0;
}

} // namespace keyhole
