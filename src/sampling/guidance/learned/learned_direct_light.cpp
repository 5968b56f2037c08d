#include "sampling/guidance/learned/learned_direct_light.h"

#include "core/kronecker.h"
#include "sampling/paths/direct_light.h"

#include <algorithm>
#include <array>
#include <functional>

namespace keyhole {
namespace {

/// Samples of a cell, at least: half of them make its histogram while the other half tells how good that is.
constexpr std::size_t kLeastFound = 128;
/// Samples of a wider cell over those of a cell.
constexpr std::size_t kTimesWider = 16;
/// Shares of the light tree that a cell chooses among.
constexpr std::array<double, 6> kPlainShares{0.1, 0.2, 0.35, 0.5, 0.75, 1};
/// Second moment over that of asking the light tree for the middle of the cell, below which it is asked for each place.
constexpr double kWorthAPlace = 0.8;
/// How far beyond its finds a cell knows anything, over the diagonal of the box around them. Cells fill all of space,
/// and a ray through two doors may end ten rooms away, at the light of a lamp that nobody found.
constexpr float kBeyond = 1;

SurfacePoint point_of(std::uint32_t emitter, SurfacePoint point) {
    point.emitter = emitter;
    return point;
}

/// The place that is nearest to the mean of all.
SurfacePoint middle_of(std::span<const FoundLight* const> found) {
    Imath::V3d sum(0.0);
    for (const FoundLight* f : found) sum += Imath::V3d(f->at.p);
    const Vec3 mean(sum / static_cast<double>(found.size()));
    const FoundLight* nearest =
        *std::ranges::min_element(found, {}, [&](const FoundLight* f) { return (f->at.p - mean).length2(); });
    SurfacePoint point;
    point.p = nearest->at.p;
    point.ng = point.ns = nearest->at.n;
    return point;
}

Imath::Box3f known_around(std::span<const FoundLight* const> found) {
    Imath::Box3f box;
    for (const FoundLight* f : found) box.extendBy(f->at.p);
    const Vec3 beyond(kBeyond * box.size().length());
    return {box.min - beyond, box.max + beyond};
}

} // namespace

const LearnedDirectLight::Cell& LearnedDirectLight::cell_of(const SurfaceCells::Place& at) const {
    const Cell& cell = cells_[tree_.cell_of(at)];
    return cell.known.intersects(at.p) ? cell : unknown_;
}

const LearnedDirectLight::Share* LearnedDirectLight::Cell::share_of(std::uint32_t emitter) const {
    const auto at = std::ranges::lower_bound(shares, emitter, {}, &Share::emitter);
    return at != shares.end() && at->emitter == emitter ? &*at : nullptr;
}

double LearnedDirectLight::Cell::pdf(std::uint32_t emitter, const Vec3& p, const Vec3& w, double point_pdf) const {
    const Share* share = share_of(emitter);
    if (share == nullptr) return 0;
    return share->probability * (share->directions == nullptr ? point_pdf : share->directions->pdf(p, w));
}

/// An emitter's share is the root of the second moment that its samples have when they are drawn as they will be.
std::vector<LearnedDirectLight::Share> LearnedDirectLight::make_shares(std::span<const FoundLight* const> found,
                                                                       const WiderCells::Directions& wider,
                                                                       const Cell* like) {
    std::vector<const FoundLight*> sorted(found.begin(), found.end());
    std::ranges::stable_sort(sorted, {}, &FoundLight::emitter);
    std::vector<Share> shares;
    double sum = 0;
    for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
        Share share{.emitter = sorted[begin]->emitter};
        std::vector<DirectionHistogram::Ray> rays;
        for (; end < sorted.size() && sorted[end]->emitter == share.emitter; ++end) {
            const FoundLight& f = *sorted[end];
            if (f.infinite) rays.push_back({f.at.p, f.towards, f.value / f.density});
        }
        if (!rays.empty()) {
            const Share* model = like != nullptr ? like->share_of(share.emitter) : nullptr;
            const auto behind = wider.find(share.emitter);
            const bool has_model = model != nullptr && model->directions;
            const auto groups = has_model ? model->directions->own().groups() : DirectionMixture::groups_of(rays);
            DirectionMixture own(rays, groups);
            if (!own.empty()) // what was found may all have been nothing
                share.directions =
                    std::make_shared<NestedHistogram>(std::move(own), behind != wider.end() ? behind->second : nullptr);
        }
        for (std::size_t i = begin; i < end; ++i) {
            const FoundLight& f = *sorted[i];
            double pdf = f.point_pdf;
            if (share.directions) pdf = (pdf + share.directions->pdf(f.at.p, f.towards)) / 2;
            share.probability += f.value * f.value / (f.density * pdf);
        }
        sum += share.probability = std::sqrt(share.probability);
        shares.push_back(std::move(share));
    }
    double up_to = 0;
    for (Share& s : shares) s.up_to = up_to += s.probability /= sum;
    return shares;
}

/// What wider cells know is not held out: of their finds, these are few.
LearnedDirectLight::Cell LearnedDirectLight::make_cell(std::span<const FoundLight* const> found,
                                                       const WiderCells& wider) const {
    Cell cell;
    cell.count = found.size();
    if (found.size() < kLeastFound) return cell;
    const auto [some, others] = halves_of(found);
    std::array<double, kPlainShares.size()> by_middle{}, by_place{};
    Cell whole;
    cell.middle = middle_of(found);
    const WiderCells::Directions& behind = wider.at({cell.middle.p, cell.middle.ng});
    whole.shares = make_shares(found, behind);
    cell.known = known_around(found);
    for (Share& share : whole.shares) share.by_tree = scene_->light_tree().probability(cell.middle, share.emitter);
    for (const auto& [learned, held_out] : {std::pair{&some, &others}, std::pair{&others, &some}}) {
        cell.shares = make_shares(*learned, behind, &whole);
        for (const FoundLight* f : *held_out) {
            const double middle = whole.share_of(f->emitter)->by_tree * f->point_pdf, place = f->choice * f->point_pdf;
            const double by_shares = cell.pdf(*f), value2 = f->value * f->value / f->density;
            for (std::size_t k = 0; k < kPlainShares.size(); ++k) {
                by_middle[k] += value2 / (kPlainShares[k] * middle + (1 - kPlainShares[k]) * by_shares);
                by_place[k] += value2 / (kPlainShares[k] * place + (1 - kPlainShares[k]) * by_shares);
            }
        }
    }
    cell.at_place = *std::ranges::min_element(by_place) < kWorthAPlace * *std::ranges::min_element(by_middle);
    const auto& moments = cell.at_place ? by_place : by_middle;
    const auto best = static_cast<std::size_t>(std::ranges::min_element(moments) - moments.begin());
    cell.plain = kPlainShares[best];
    cell.ratio = moments[best] / by_place.back();
    if (cell.plain == 1) cell.at_place = true;
    cell.shares = cell.plain < 1 ? std::move(whole.shares) : std::vector<Share>{};
    return cell;
}

LearnedDirectLight::LearnedDirectLight(const Scene& scene, std::span<const FoundLight> found) : scene_(&scene) {
    SeenInCells by_cell(found, kLeastFound);
    tree_ = std::move(by_cell.tree);
    const WiderCells wider(found, kTimesWider * kLeastFound);
    bytes_of_wider_ = wider.bytes();
    cells_ = by_cell.made([&](std::span<const FoundLight* const> here) { return make_cell(here, wider); });
    double sum = 0;
    for (const Cell& cell : cells_) sum += cell.ratio * static_cast<double>(cell.count);
    if (!found.empty()) ratio_ = sum / static_cast<double>(found.size());
}

EmitterPoint LearnedDirectLight::sample(const SurfacePoint& at, SampleSource& source) const {
    const Cell& cell = cell_of(at);
    const double u = source.next();
    EmitterPoint drawn;
    if (u < cell.plain) {
        const auto [emitter, by_tree] = scene_->light_tree().sample(asked_for(cell, at), u / cell.plain);
        drawn.point = point_of(emitter, scene_->emitter(emitter).sample_point(source).point);
        drawn.pdf = pdf(cell, at, drawn.point, by_tree);
    } else {
        const double v = (u - cell.plain) / (1 - cell.plain);
        const auto above = std::ranges::upper_bound(cell.shares, v, {}, &Share::up_to);
        const Share& share = above != cell.shares.end() ? *above : cell.shares.back();
        drawn.point = point_by_share(&share, at, share.emitter, source);
        drawn.pdf = pdf(cell, at, drawn.point, by_tree(cell, at, &share, share.emitter));
    }
    return drawn;
}

SurfacePoint LearnedDirectLight::point_by_share(const Share* share, const SurfacePoint& at, std::uint32_t emitter,
                                                SampleSource& source) const {
    if (share == nullptr || share->directions == nullptr)
        return point_of(emitter, scene_->emitter(emitter).sample_point(source).point);
    const auto [u0, u1] = source.take<2>();
    return point_of(emitter, infinite_point(share->directions->sample(at.p, u0, u1)));
}

double LearnedDirectLight::probability(const SurfacePoint& at, std::uint32_t emitter) const {
    const Cell& cell = cell_of(at);
    const Share* share = cell.share_of(emitter);
    return probability(cell, share, by_tree(cell, at, share, emitter));
}

EmitterPoint LearnedDirectLight::sample_of(const SurfacePoint& at, std::uint32_t emitter, double u,
                                           SampleSource& source) const {
    const Cell& cell = cell_of(at);
    const Share* share = cell.share_of(emitter);
    const double tree = by_tree(cell, at, share, emitter);
    const bool plain = u * probability(cell, share, tree) < cell.plain * tree;
    const SurfacePoint x0 = point_by_share(plain ? nullptr : share, at, emitter, source);
    return {x0, pdf(cell, at, x0, tree)};
}

double LearnedDirectLight::by_tree(const Cell& cell, const SurfacePoint& at, const Share* share,
                                   std::uint32_t emitter) const {
    if (share != nullptr && !cell.at_place) return share->by_tree;
    return scene_->light_tree().probability(asked_for(cell, at), emitter);
}

double LearnedDirectLight::pdf(const Cell& cell, const SurfacePoint& at, const SurfacePoint& x0, double by_tree) const {
    const Emitter& emitter = scene_->emitter(x0.emitter);
    const double point_pdf = emitter.point_pdf(x0);
    double sum = cell.plain * by_tree * point_pdf;
    if (cell.plain < 1) sum += (1 - cell.plain) * cell.pdf(x0.emitter, at.p, direction(at, x0), point_pdf);
    return sum;
}

double LearnedDirectLight::pdf(const SurfacePoint& at, const SurfacePoint& x0) const {
    const Cell& cell = cell_of(at);
    return pdf(cell, at, x0, by_tree(cell, at, cell.share_of(x0.emitter), x0.emitter));
}

double LearnedDirectLight::pdf(const FoundLight& f) const {
    const Cell& cell = cell_of(f.at);
    const double tree = cell.at_place ? f.choice : by_tree(cell, cell.middle, cell.share_of(f.emitter), f.emitter);
    return cell.plain * tree * f.point_pdf + (1 - cell.plain) * cell.pdf(f);
}

std::vector<EmitterChance> LearnedDirectLight::chances(const SurfacePoint& at, int directions) const {
    const Cell& cell = cell_of(at);
    std::vector<EmitterChance> list;
    for (const Share& share : cell.shares) {
        EmitterChance chance{share.emitter, probability(cell, &share, by_tree(cell, at, &share, share.emitter))};
        for (int i = 0; i < directions && share.directions; ++i)
            chance.towards.push_back(share.directions->sample(at.p, (i + 0.5) / directions, kronecker(0.5, i, kR2[1])));
        list.push_back(std::move(chance));
    }
    std::ranges::stable_sort(list, std::greater<>(), &EmitterChance::probability);
    return list;
}

std::size_t LearnedDirectLight::bytes() const {
    std::size_t sum = tree_.bytes() + cells_.capacity() * sizeof(Cell) + bytes_of_wider_;
    for (const Cell& cell : cells_) {
        sum += cell.shares.capacity() * sizeof(Share);
        for (const Share& share : cell.shares)
            if (share.directions) sum += sizeof(NestedHistogram) + share.directions->bytes();
    }
    return sum;
}

} // namespace keyhole
