#include "photonmap/power/light_path_power.h"

#include "sampling/guidance/guided_light.h"
#include "sampling/paths/measure.h"

namespace keyhole {

std::optional<Rgb> light_path_power(const Scene& scene, const LightPathSampling& sampling, const Path& path, int last) {
    static const LightGuides none;
    GuidedLightWalk walk(scene, sampling.guided() ? *sampling.user_paths : none);
    const auto& x = path.x;
    const auto end = static_cast<std::size_t>(last);
    for (std::size_t i = 0; i < end; ++i) {
        const Vec3 along = direction(x[i].point, x[i + 1].point);
        if (!(i == 0 ? walk.emit(x[0], along) : walk.leave(x[i].event, along) > 0)) return std::nullopt;
        walk.arrive(x[i + 1]);
    }
    const LearnedEmission* learned = sampling.emission();
    if (learned == nullptr) return walk.power();
    const double ratio = learned->density_ratio(x[0].point, direction(x[0].point, x[1].point), x[1].point.p);
    return ratio > 0 ? std::optional(walk.power() / ratio) : std::nullopt;
}

} // namespace keyhole
