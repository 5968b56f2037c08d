#include "sampling/paths/gather_coverage.h"

#include "core/shared_work.h"
#include "core/vec.h"
#include "sampling/paths/eye_path_head.h"
#include "sampling/paths/image_lattice.h"
#include "sampling/paths/light_tracer.h"

#include <algorithm>
#include <array>

namespace keyhole {
namespace {

constexpr std::int64_t kBlocks = 64;
constexpr std::uint64_t kSeed = 1; // the same for every seed: passes and their shares must agree

/// How many rays come near the typical ray's end at least; cells grow until they do.
constexpr int kTypical = 32;
/// Rays come to a place if they are as dense there as this share of what is typical.
constexpr double kLeast = 1.0 / 32;

constexpr float kFinest = 0.01f, kCoarsest = 0.08f; // cells, in parts of the scene's size
constexpr int kBits = 20;                           // of a cell's coordinate
constexpr float kLift = 0.05f;                      // of places above their surface, in cells
constexpr int kProbees = 8;                         // of a cell, at most

/// Where a gather ray asks.
struct Place {
    Vec3 p, n;
};

std::vector<Place> trace_places(const Scene& scene, int max_scatterings, std::int64_t paths,
                                const RunContext& context) {
    std::vector<std::vector<Place>> parts(kBlocks);
    parallel_for(kBlocks, context, [&](std::int64_t b) {
        const Range range = split(paths, kBlocks, b);
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            Rng rng(kSeed, StreamPurpose::coverage, static_cast<std::uint64_t>(i));
            trace_eye_path_head(scene, lattice_image_point(kSeed, StreamPurpose::coverage, i), max_scatterings, rng,
                                [&](const Vertex& v, const Vec3& to_eye, const Rgb&, const EyePast& past) {
                                    if (past.finite != 1) return;
                                    std::vector<Place>& part = parts[static_cast<std::size_t>(b)];
                                    part.push_back({v.point.p, facing(v.point.ng, to_eye)});
                                    // What lights a lampshade from inside is asked for from outside.
                                    if (v.bsdf.traits().through) part.push_back({v.point.p, -part.back().n});
                                });
        }
    });
    std::vector<Place> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::uint64_t key_of(const std::array<std::int64_t, 3>& c, std::uint64_t facet) {
    std::uint64_t key = facet;
    for (const std::int64_t i : c)
        key = key << kBits | static_cast<std::uint64_t>(std::clamp<std::int64_t>(i, 0, (1 << kBits) - 1));
    return key;
}

/// visit(key) for a cell and those around it that face alike.
template <class Visit> void visit_around(std::uint64_t key, const Visit& visit) {
    constexpr std::uint64_t mask = (1 << kBits) - 1;
    const auto x = static_cast<std::int64_t>(key >> 2 * kBits & mask),
               y = static_cast<std::int64_t>(key >> kBits & mask), z = static_cast<std::int64_t>(key & mask);
    for (std::int64_t i = x - 1; i <= x + 1; ++i)
        for (std::int64_t j = y - 1; j <= y + 1; ++j)
            for (std::int64_t k = z - 1; k <= z + 1; ++k) visit(key_of({i, j, k}, key >> 3 * kBits));
}

struct Count {
    std::uint64_t cell;
    int rays;
    std::size_t first = 0; ///< of the rays that end in the cell, if it is one cell that is counted
};

/// The item of that cell; null if there is none.
const Count* find(const std::vector<Count>& counts, std::uint64_t cell) {
    const auto at = std::ranges::lower_bound(counts, cell, {}, &Count::cell);
    return at != counts.end() && at->cell == cell ? &*at : nullptr;
}

/// The rays that end in each cell, given the cells of all of them in order.
std::vector<Count> count_in(const std::vector<std::uint64_t>& cells) {
    std::vector<Count> counts;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (counts.empty() || counts.back().cell != cells[i]) counts.push_back({cells[i], 0, i});
        ++counts.back().rays;
    }
    return counts;
}

/// For each cell, the rays that come to it and to those around it.
std::vector<Count> count_around(const std::vector<Count>& in_cells) {
    std::vector<Count> around;
    around.reserve(27 * in_cells.size());
    for (const Count& c : in_cells) visit_around(c.cell, [&](std::uint64_t cell) { around.push_back({cell, c.rays}); });
    std::ranges::sort(around, {}, &Count::cell);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < around.size(); ++i) {
        if (kept > 0 && around[kept - 1].cell == around[i].cell)
            around[kept - 1].rays += around[i].rays;
        else
            around[kept++] = around[i];
    }
    around.resize(kept);
    return around;
}

/// Rays around the median ray's end.
int typical_count(const std::vector<Count>& in_cells, const std::vector<Count>& around) {
    std::vector<std::pair<int, int>> ends; // rays around, rays
    std::int64_t rays = 0;
    for (const Count& c : in_cells) {
        ends.emplace_back(find(around, c.cell)->rays, c.rays);
        rays += c.rays;
    }
    std::ranges::sort(ends);
    std::int64_t before = 0;
    for (const auto& [near, here] : ends)
        if ((before += here) >= rays / 2) return near;
    return 0;
}

/// Up to kProbees of the rays that end in a cell and around it, evenly spread over them: their numbers.
std::vector<std::size_t> choose_probes(const std::vector<Count>& in_cells, const Count& around) {
    const int chosen = std::min(kProbees, around.rays);
    std::vector<std::size_t> probes;
    int before = 0;
    visit_around(around.cell, [&](std::uint64_t cell) {
        const Count* c = find(in_cells, cell);
        if (c == nullptr) return;
        for (auto next = probes.size(); next < static_cast<std::size_t>(chosen); next = probes.size()) {
            const int rank = (2 * static_cast<int>(next) + 1) * around.rays / (2 * chosen);
            if (rank >= before + c->rays) break;
            probes.push_back(c->first + static_cast<std::size_t>(rank - before));
        }
        before += c->rays;
    });
    return probes;
}

} // namespace

GatherCoverage::GatherCoverage(const Scene& scene, int max_scatterings, std::int64_t paths, const RunContext& context)
    : scene_(&scene), origin_(scene.lower()) {
    std::vector<Place> places = trace_places(scene, max_scatterings, paths, context);
    const float extent = (scene.upper() - scene.lower()).length();
    std::vector<Count> in_cells, around;
    int typical = 0;
    for (size_ = kFinest * extent; size_ > 0; size_ *= 2) {
        std::ranges::stable_sort(places, {}, [&](const Place& place) { return key(place.p, place.n); });
        std::vector<std::uint64_t> keys;
        keys.reserve(places.size());
        for (const Place& place : places) keys.push_back(key(place.p, place.n));
        in_cells = count_in(keys);
        around = count_around(in_cells);
        typical = typical_count(in_cells, around);
        if (typical >= kTypical || 2 * size_ > kCoarsest * extent) break;
    }
    const double least = kLeast * typical;
    for (const Count& c : around)
        if (c.rays >= least) cells_.push_back({c.cell});
    for (Cell& cell : cells_) {
        const Count& c = *find(around, cell.key);
        const std::vector<std::size_t> probes = choose_probes(in_cells, c);
        if (std::ranges::none_of(probes, [&](std::size_t i) { return obstructed(places[i].p, places[i].n); })) continue;
        cell.first = static_cast<std::uint32_t>(probes_.size());
        cell.probes = static_cast<std::uint8_t>(probes.size());
        const double each = static_cast<double>(c.rays) / static_cast<double>(probes.size());
        cell.least =
            static_cast<std::uint8_t>(std::clamp(std::ceil(least / each), 1.0, static_cast<double>(probes.size())));
        for (const std::size_t i : probes) probes_.push_back(above(places[i].p, places[i].n));
    }
    cells_.shrink_to_fit();
    probes_.shrink_to_fit();
}

std::uint64_t GatherCoverage::key(const Vec3& p, const Vec3& n) const {
    const Vec3 at = (p - origin_) / size_;
    // One free cell all around, so that no neighbour falls off the edge.
    return key_of(
        {static_cast<std::int64_t>(at.x) + 1, static_cast<std::int64_t>(at.y) + 1, static_cast<std::int64_t>(at.z) + 1},
        facet_of(n));
}

/// So far that what is low parts nothing.
Vec3 GatherCoverage::above(const Vec3& p, const Vec3& n) const { return p + n * (kLift * size_); }

/// Whether something stands so near a place of the surface that it may hide others of the same cell.
bool GatherCoverage::obstructed(const Vec3& p, const Vec3& n) const {
    constexpr float kFar = 3; // cells: the place may be one cell off
    const Frame frame(n);
    const Vec3 from = above(p, n);
    for (const Vec3& w : {frame.s, frame.t})
        for (const float far : {-kFar, kFar})
            if (!scene_->visible(from, from + w * (far * size_))) return true;
    return false;
}

bool GatherCoverage::comes_to(const Vec3& p, const Vec3& n) const {
    const auto cell = std::ranges::lower_bound(cells_, key(p, n), {}, &Cell::key);
    if (cell == cells_.end() || cell->key != key(p, n)) return false;
    if (cell->probes == 0) return true;
    const Vec3 place = above(p, n);
    int seen = 0;
    for (int i = 0; i < cell->probes && seen < cell->least; ++i)
        seen += scene_->visible(probes_[cell->first + static_cast<std::size_t>(i)], place) ? 1 : 0;
    return seen >= cell->least;
}

double light_outside_coverage(const Scene& scene, const GatherCoverage& coverage, int max_scatterings,
                              std::int64_t paths, const RunContext& context) {
    struct Sink {
        const GatherCoverage& coverage;
        double all = 0, beyond = 0;

        bool arrival(const Vertex& v, const Vec3& to_light, const Rgb& power, const LightPast& past) {
            if (!past.last || !v.bsdf.traits().finite) return true;
            all += luminance(power);
            if (!coverage.comes_to(v.point.p, facing(v.point.ng, to_light))) beyond += luminance(power);
            return true;
        }
    };
    std::vector<Sink> sinks(kBlocks, Sink{coverage});
    parallel_for(kBlocks, context, [&](std::int64_t b) {
        const Range range = split(paths, kBlocks, b);
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            Rng rng(kSeed, StreamPurpose::light_beyond_coverage, static_cast<std::uint64_t>(i));
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
