#include "photonmap/power/technique_weights.h"

#include "sampling/paths/measure.h"

#include <limits>

namespace keyhole {

std::optional<Rgb> light_path_power(const Scene& scene, const LightPathSampling& sampling, const Path& path, int last) {
    GuidedLightWalk walk(scene, sampling);
    const auto& x = path.x;
    for (int i = 0; i < last; ++i) {
        const Vec3 along = direction(x[i].point, x[i + 1].point);
        if (!(i == 0 ? walk.emit(x[0].point, along) : walk.leave(x[i].event, along) > 0)) return std::nullopt;
        walk.arrive(x[i + 1]);
    }
    return walk.past().density > 0 ? std::optional(walk.power()) : std::nullopt;
}

PhotonWeighing::Weight TechniqueWeights::visible(const Scene& scene, PhotonKind kind, const Path& path, int at) const {
    const auto power = light_path_power(scene, sampling_, path, at);
    if (!power) return {std::numeric_limits<double>::infinity(), true};
    return weighing_(kind, path.x[at], direction(path.x[at].point, path.x[at - 1].point), *power);
}

} // namespace keyhole
