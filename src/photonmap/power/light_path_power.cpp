#include "photonmap/power/light_path_power.h"

#include "sampling/paths/measure.h"

namespace keyhole {

std::optional<Rgb> light_path_power(const Scene& scene, const LightPathSampling& sampling, const Path& path, int last) {
    GuidedLightWalk walk(scene, sampling);
    const auto& x = path.x;
    const auto end = static_cast<std::size_t>(last);
    for (std::size_t i = 0; i < end; ++i) {
        const Vec3 along = direction(x[i].point, x[i + 1].point);
        if (!(i == 0 ? walk.emit(x[0].point, along) : walk.leave(x[i].event, along) > 0)) return std::nullopt;
        walk.arrive(x[i + 1]);
    }
    return walk.past().density > 0 ? std::optional(walk.power()) : std::nullopt;
}

} // namespace keyhole
