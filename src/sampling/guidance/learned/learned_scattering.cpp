#include "sampling/guidance/learned/learned_scattering.h"

#include "sampling/paths/measure.h"

#include <algorithm>
#include <array>

namespace keyhole {
namespace {

/// Paths of a cell, at least: half of them make its histogram while the other half tells how good that is.
constexpr std::size_t kLeastSeen = 64;
/// Shares of the BSDF that a cell chooses among.
constexpr std::array<double, 5> kBsdfShares{0.2, 0.35, 0.5, 0.75, 1};
/// Second moment over that of the BSDF alone above which a histogram isn't worth its while.
constexpr double kWorthwhile = 0.8;
/// A path counts as so many times the mean at most: what was hard to find must not draw all light to where it was.
constexpr double kMostOfMean = 20;

std::vector<DirectionHistogram::Ray> rays_of(std::span<const SeenScattering* const> seen, double most_weight) {
    std::vector<DirectionHistogram::Ray> rays;
    rays.reserve(seen.size());
    for (const SeenScattering* s : seen) rays.push_back({s->at.p, s->towards, std::min(s->weight, most_weight)});
    return rays;
}

} // namespace

LearnedScattering::LearnedScattering(std::span<const SeenScattering> seen) {
    SeenInCells by_cell(seen, kLeastSeen);
    tree_ = std::move(by_cell.tree);
    cells_ = by_cell.made(make_cell);
    double all = 0;
    for (std::size_t i = 0; i < cells_.size(); ++i)
        for (const SeenScattering* s : by_cell.cells[i]) {
            all += s->weight;
            if (cells_[i].plain < 1) helped_ += s->weight;
        }
    if (all > 0) helped_ /= all;
}

LearnedScattering::Cell LearnedScattering::make_cell(std::span<const SeenScattering* const> found) {
    if (found.size() < kLeastSeen) return {};
    double sum = 0;
    for (const SeenScattering* s : found) sum += s->weight;
    const double most_weight = kMostOfMean * sum / static_cast<double>(found.size());

    const std::vector<DirectionHistogram::Ray> rays = rays_of(found, most_weight);
    const auto plane = DirectionHistogram::meeting_plane(rays);
    const auto [some, others] = halves_of(found);
    // Light that goes on in a direction carries the BSDF's density over that of the choice: what is wanted from there
    // does so on average, since `seen` is distributed as what is wanted.
    std::array<double, kBsdfShares.size()> moments{};
    for (const auto& [learned, held_out] : {std::pair{&some, &others}, std::pair{&others, &some}}) {
        const DirectionHistogram directions(rays_of(*learned, most_weight), plane);
        if (directions.empty()) return {};
        for (const SeenScattering* s : *held_out) {
            const double by_histogram = directions.pdf(s->at.p, s->towards);
            for (std::size_t k = 0; k < moments.size(); ++k)
                moments[k] += std::min(s->weight, most_weight) * s->pdf /
                              (kBsdfShares[k] * s->pdf + (1 - kBsdfShares[k]) * by_histogram);
        }
    }
    const auto best = static_cast<std::size_t>(std::ranges::min_element(moments) - moments.begin());
    if (!(moments[best] < kWorthwhile * moments.back())) return {};
    return {kBsdfShares[best], DirectionHistogram(rays, plane)};
}

std::optional<Continuation> LearnedScattering::continue_walk(const Vertex& v, const Vec3& to_light,
                                                             SampleSource& source, double& reference) const {
    const auto plain = [&] { return keyhole::continue_walk(v, to_light, From::light, source); };
    // Events that have no density would have to be told from those of the mixture.
    if (v.bsdf.traits().delta || !v.bsdf.traits().finite) return plain();
    const Cell& cell = cell_at({v.point.p, facing(v.point.ng, to_light)});
    if (cell.plain == 1) return plain();

    Vec3 w;
    if (source.next() < cell.plain) {
        const auto s = v.bsdf.sample(to_light, source);
        if (!s) return std::nullopt;
        w = s->to;
    } else {
        const auto [u0, u1] = source.take<2>();
        w = cell.directions.sample(v.point.p, u0, u1);
    }
    const ScatterValue value = scatter(v.point, v.bsdf, Event::finite, to_light, w);
    const double pdf = cell.plain * value.pdf_to_eye + (1 - cell.plain) * cell.directions.pdf(v.point.p, w);
    if (!(pdf > 0) || is_black(value.value)) return std::nullopt;
    reference *= value.pdf_to_eye / pdf;
    return Continuation{w, Event::finite, value.value * (v.point.abs_cos(w) / pdf), pdf, pdf, value.pdf_to_light};
}

std::size_t LearnedScattering::bytes() const {
    std::size_t sum = tree_.bytes() + cells_.capacity() * sizeof(Cell);
    for (const Cell& cell : cells_) sum += cell.directions.bytes();
    return sum;
}

} // namespace keyhole
