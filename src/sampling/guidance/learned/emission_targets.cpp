#include "sampling/guidance/learned/emission_targets.h"

#include "core/parallel.h"
#include "scene/warp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace keyhole {
namespace {

/// Targets of a cell, at least: histograms of directions need many.
constexpr std::size_t kLeastTargets = 384;
/// A target's disc reaches to its neighbour of this number in the cell.
constexpr std::size_t kNeighbour = 6;
/// Radius of a disc, at least, over that of the scene.
constexpr float kLeastRadius = 1e-5f;
/// Targets that are looked at side by side.
constexpr std::size_t kBlock = 64;

/// Distance to the neighbour that a target's disc reaches to.
float radius_of(const SeenLight& target, std::span<const SeenLight* const> cell, std::vector<float>& squares) {
    squares.clear();
    for (const SeenLight* other : cell) squares.push_back((other->at.p - target.at.p).length2());
    const std::size_t k = std::min(kNeighbour, squares.size() - 1);
    std::ranges::nth_element(squares, squares.begin() + static_cast<std::ptrdiff_t>(k));
    return std::sqrt(squares[k]);
}

Vec3 on_disc(const Vec3& center, const Vec3& n, float radius, SampleSource& source) {
    const auto [u0, u1] = source.take<2>();
    const Vec2 d = uniform_disc(u0, u1) * radius;
    return center + Frame(n).to_world(Vec3(d.x, d.y, 0));
}

} // namespace

EmissionTargets::EmissionTargets(const Scene& scene, std::span<const SeenLight> seen) : scene_(&scene) {
    if (seen.empty()) return;
    std::vector<SurfaceCells::Place> places;
    places.reserve(seen.size());
    for (const SeenLight& s : seen) places.push_back(s.at);
    tree_ = SurfaceCells(std::move(places), kLeastTargets);
    std::vector<std::vector<const SeenLight*>> by_cell(tree_.size());
    for (const SeenLight& s : seen) by_cell[tree_.cell_of(s.at)].push_back(&s);
    cells_.resize(tree_.size());
    parallel_for(static_cast<std::int64_t>(cells_.size()), [&](std::int64_t i) {
        std::vector<const SeenLight*>& here = by_cell[static_cast<std::size_t>(i)];
        std::ranges::stable_sort(here, {}, &SeenLight::emitter);
        cells_[static_cast<std::size_t>(i)] = make_cell(here, kLeastRadius * scene.bounding_sphere().radius);
    });
    std::vector<double> weights;
    for (const Cell& cell : cells_) weights.push_back(cell.weight);
    choice_ = EmitterDistribution(weights);
    if (choice_.empty()) cells_.clear();
}

/// `seen`: sorted by emitter.
EmissionTargets::Cell EmissionTargets::make_cell(std::span<const SeenLight* const> seen, float least_radius) {
    Cell cell;
    std::vector<float> squares;
    for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end) {
        const std::uint32_t emitter = seen[begin]->emitter;
        std::vector<DirectionHistogram::Ray> rays;
        for (; end < seen.size() && seen[end]->emitter == emitter; ++end) {
            const SeenLight& s = *seen[end];
            for (int k = 0; k < 3; ++k) cell.x[k].push_back(s.at.p[k]);
            cell.radius.push_back(std::max(radius_of(s, seen, squares), least_radius));
            cell.probability.push_back(s.weight);
            cell.up_to.push_back(cell.weight += s.weight);
            if (s.environment) rays.push_back({s.at.p, s.towards, s.weight});
        }
        DirectionHistogram directions;
        if (!rays.empty()) directions = DirectionHistogram(rays, DirectionHistogram::meeting_plane(rays));
        cell.shares.push_back({emitter, begin, end, std::move(directions)});
    }
    for (std::size_t i = 0; i < seen.size() && cell.weight > 0; ++i) {
        cell.probability[i] /= cell.weight;
        cell.up_to[i] /= cell.weight;
    }
    return cell;
}

std::optional<EmissionTargets::Drawn> EmissionTargets::sample(double u, SampleSource& source) const {
    Drawn drawn{{}, choice_.sample(u)};
    const Cell& cell = cells_[drawn.cell];
    const auto above = std::ranges::upper_bound(cell.up_to, source.next());
    const auto i = std::min(static_cast<std::size_t>(above - cell.up_to.begin()), cell.up_to.size() - 1);
    const Share& share = *std::ranges::upper_bound(cell.shares, i, {}, &Share::end);
    const Emitter& emitter = scene_->emitter(share.emitter);
    const Vec3 target = cell.at(i);
    auto& [x0, ray] = drawn.edge;
    if (share.directions.empty()) {
        x0 = emitter.sample_point(source).point;
    } else {
        const auto [u0, u1] = source.take<2>();
        x0 = infinite_point(share.directions.sample(target, u0, u1));
    }
    x0.emitter = share.emitter;
    if (emitter.site() == Site::infinite) {
        const BoundingSphere scene = scene_->bounding_sphere();
        const Vec3 at = on_disc(target, x0.ng, cell.radius[i], source);
        ray.w = x0.ng;
        ray.origin.site = Site::point;
        ray.origin.p = at - ray.w * ((at - scene.center).dot(ray.w) + scene.radius); // before everything in the scene
    } else {
        const Vec3 to = target - x0.p;
        if (!(to.length2() > 0)) return std::nullopt;
        ray.w = (on_disc(target, to.normalized(), cell.radius[i], source) - x0.p).normalized();
        ray.origin = x0;
    }
    return drawn;
}

double EmissionTargets::pdf(const SurfacePoint& x0, const SurfacePoint& x1) const {
    const std::uint32_t i = cell_of(x1, direction(x0, x1));
    const Cell& cell = cells_[i];
    const auto share = std::ranges::lower_bound(cell.shares, x0.emitter, {}, &Share::emitter);
    if (share == cell.shares.end() || share->emitter != x0.emitter) return 0;
    return choice_.probability(i) * pdf_of_targets(cell, *share, x0, x1);
}

double EmissionTargets::pdf_of_targets(const Cell& cell, const Share& share, const SurfacePoint& x0,
                                       const SurfacePoint& x1) const {
    const Vec3 w = direction(x0, x1);
    const bool infinite = x0.site == Site::infinite;
    const Vec3 from = infinite ? x1.p : x0.p;
    const double own = scene_->emitter(share.emitter).point_pdf(x0);
    double sum = 0;
    std::array<float, kBlock> beyond; // how far beyond its disc the ray passes each target, in squares of some length
    for (std::size_t begin = share.begin; begin < share.end; begin += kBlock) {
        const std::size_t count = std::min(kBlock, share.end - begin);
        const float *x = &cell.x[0][begin], *y = &cell.x[1][begin], *z = &cell.x[2][begin], *r = &cell.radius[begin];
        for (std::size_t i = 0; i < count; ++i) {
            const float dx = x[i] - from.x, dy = y[i] - from.y, dz = z[i] - from.z;
            const float square = dx * dx + dy * dy + dz * dz, along = dx * w.x + dy * w.y + dz * w.z;
            // A disc lies across the direction of the emitter's point: seen from there it is a cone.
            const float stretch = infinite ? 1 : along * std::abs(along) / square;
            beyond[i] = square - along * along - r[i] * r[i] * stretch;
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (beyond[i] > 0) continue;
            const std::size_t k = begin + i;
            const Vec3 target = cell.at(k), to = target - from;
            double density = kInvPi / (static_cast<double>(cell.radius[k]) * cell.radius[k]); // per area of the disc
            if (!infinite) {
                const double distance = to.length(), cosine = w.dot(to) / distance, along = distance / cosine;
                if (!(cosine > 0)) continue;
                density *= along * along / cosine;
            }
            sum += cell.probability[k] * density * (share.directions.empty() ? own : share.directions.pdf(target, -w));
        }
    }
    return sum;
}

std::size_t EmissionTargets::bytes() const {
    std::size_t sum = tree_.bytes() + cells_.capacity() * sizeof(Cell);
    for (const Cell& cell : cells_) {
        sum +=
            cell.radius.capacity() * (4 * sizeof(float) + 2 * sizeof(double)) + cell.shares.capacity() * sizeof(Share);
        for (const Share& share : cell.shares) sum += share.directions.bytes();
    }
    return sum;
}

} // namespace keyhole
