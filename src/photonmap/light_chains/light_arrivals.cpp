#include "photonmap/light_chains/light_arrivals.h"

#include "photonmap/power/power.h"
#include "sampling/paths/bidirectional_tracer.h"

#include <cmath>

namespace keyhole {

void LightArrivals::add(PhotonKind kind, const Vertex& v, const Vec3& to_light, const Rgb& power, bool caustic,
                        const PhotonWeighing::Weight& weight) {
    const auto value = static_cast<float>(weight.value);
    if (!std::isfinite(value) || !is_finite(power)) {
        broken_ = true;
        return;
    }
    if (!(value > 0)) return;
    target_ += value;
    arrivals_.push_back(
        {Photon(v.point.p, v.point.ng, to_light, emitted_power(power, value), caustic), value, kind, weight.known});
}

void LightBuilder::store(PhotonKind kind, const Vertex& v, const Vec3& to_light, const Rgb& power, bool caustic,
                         LightArrivals& sample) const {
    sample.add(kind, v, to_light, power, caustic, weighing_(kind, v, to_light, power));
}

void LightBuilder::build(LightSources sources, LightArrivals& sample) const {
    TracedSubPath& walk = SubPathPair::scratch().light;
    trace_light_subpath(*scene_, most_light_vertices(rule_.max_scatterings), sources.light, &sources.roulette, walk);
    LightPast past;
    past.from_infinity = walk.size() > 0 && walk.vertices[0].point.site == Site::infinite;
    for (int i = 1; i < walk.size(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        Vertex& v = walk.vertices[at];
        if (v.point.site != Site::surface) return;
        const Vec3& to_light = walk.notes[at].back;
        const Rgb& power = walk.notes[at].throughput;
        if (v.bsdf.traits().finite && luminance(power) > 0) {
            const StorageRule::Kinds kinds = rule_(v, to_light, past);
            if (kinds.global) store(PhotonKind::global, v, to_light, power, past.caustic(), sample);
            if (kinds.caustic) store(PhotonKind::caustic, v, to_light, power, past.caustic(), sample);
        }
        // The event at the end of the walk was never asked for.
        if (i + 1 == walk.size()) return;
        past.meet(v, to_light);
    }
}

} // namespace keyhole
