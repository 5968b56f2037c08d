#include "photonmap/deposit.h"

#include <utility>

namespace keyhole {

bool PathDepositor::Pending::holds(const Path& path, const StoragePoint& at) const {
    const auto i = static_cast<std::size_t>(at.vertex);
    return kind == at.kind && vertex.point.p == path.x[i].point.p &&
           to_light == direction(path.x[i].point, path.x[i - 1].point);
}

void PathDepositor::deposit(const Path& path, double weight) {
    const StoragePoint at = storage_point(path);
    if (at.kind == PhotonKind::none || !(weight > 0)) return;
    total_ += weight;
    if (!recent_.holds(path, at)) {
        std::swap(recent_, older_);
        if (!recent_.holds(path, at)) {
            store(recent_);
            const auto i = static_cast<std::size_t>(at.vertex);
            Rgb flux(1.0);
            for (std::size_t k = 0; k < i; ++k) flux *= path.x[k].value / luminance(path.x[k].value);
            recent_ = {at.kind, path.x[i], direction(path.x[i].point, path.x[i - 1].point), flux, 0};
        }
    }
    recent_.weight += weight;
}

void PathDepositor::flush() {
    store(older_);
    store(recent_);
}

void PathDepositor::store(Pending& pending) {
    const bool global = pending.kind == PhotonKind::global;
    pending.kind = PhotonKind::none;
    const double given = std::exchange(pending.weight, 0);
    if (!(given > 0)) return;
    const double weight = roulette(given, global ? global_threshold_ : caustic_threshold_, rng_);
    if (weight == 0) return;

    const ImportanceMap& map = global ? *importance_.global : *importance_.caustic;
    const auto e = map.importance(pending.vertex.point, pending.vertex.bsdf, pending.to_light);
    const double visible = luminance(pending.flux * e.value);
    if (!(visible > 0)) {
        lost_ += weight;
        return;
    }
    PhotonBuffer& buffer = global ? global_ : caustic_;
    buffer.photons.emplace_back(pending.vertex.point.p, pending.vertex.point.ng, pending.to_light,
                                pending.flux / visible);
    buffer.weights.push_back(static_cast<float>(weight));
}

} // namespace keyhole
