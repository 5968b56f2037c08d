#include "sampling/guidance/learned/wider_cells.h"

#include <algorithm>
#include <iterator>

namespace keyhole {
namespace {

/// Finds that make a histogram: more tell little more here, and every shadow ray asks for its density.
constexpr std::size_t kFinds = 256;

WiderCells::Directions histograms(std::span<const FoundLight* const> found) {
    std::map<std::uint32_t, std::vector<DirectionHistogram::Ray>> rays;
    const std::size_t stride = std::max<std::size_t>(1, found.size() / kFinds);
    for (std::size_t i = 0; i < found.size(); i += stride) {
        const FoundLight& f = *found[i];
        rays[f.emitter].push_back({f.at.p, f.towards, f.value / f.density});
    }
    WiderCells::Directions all;
    for (const auto& [emitter, of_emitter] : rays) {
        DirectionMixture mixture(of_emitter, DirectionMixture::groups_of(of_emitter));
        if (!mixture.empty()) all[emitter] = std::make_shared<const DirectionMixture>(std::move(mixture));
    }
    return all;
}

/// Of all directions, those of the wider cell.
constexpr double kWiderShare = 0.25;

} // namespace

WiderCells::WiderCells(std::span<const FoundLight> found, std::size_t least) {
    std::vector<FoundLight> sky;
    std::ranges::copy_if(found, std::back_inserter(sky), &FoundLight::infinite);
    SeenInCells by_cell(std::span<const FoundLight>(sky), least);
    tree_ = std::move(by_cell.tree);
    cells_ = by_cell.made(histograms);
}

std::size_t WiderCells::bytes() const {
    std::size_t sum = tree_.bytes() + cells_.capacity() * sizeof(Directions);
    for (const Directions& cell : cells_)
        for (const auto& [emitter, mixture] : cell) sum += sizeof(DirectionMixture) + mixture->bytes();
    return sum;
}

Vec3 NestedHistogram::sample(const Vec3& p, double u0, double u1) const {
    if (!wider_) return own_.sample(p, u0, u1);
    if (u0 < kWiderShare) return wider_->sample(p, u0 / kWiderShare, u1);
    return own_.sample(p, (u0 - kWiderShare) / (1 - kWiderShare), u1);
}

double NestedHistogram::pdf(const Vec3& p, const Vec3& w) const {
    const DirectionHistogram::Place on_map = DirectionHistogram::place_on_map(w);
    const double own = own_.pdf(p, w, on_map);
    return wider_ ? (1 - kWiderShare) * own + kWiderShare * wider_->pdf(p, w, on_map) : own;
}

} // namespace keyhole
