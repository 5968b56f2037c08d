#include "photonmap/photon_weighing.h"

#include "photonmap/map_stores.h"
#include "sampling/paths/measure.h"

#include <limits>

namespace keyhole {

PhotonWeighing::Weight PhotonWeighing::operator()(PhotonKind kind, const Vertex& v, const Vec3& to_light,
                                                  const Rgb& power) const {
    const ImportanceGuide* map = kind == PhotonKind::global ? guide.global : guide.caustic;
    if (map == nullptr) return {1, true};
    if (const auto visible = map->visible_power(v, to_light, power)) return {*visible, true};
    return {luminance(power) * unknown_scale, false};
}

std::size_t PhotonWeights::for_caustic(std::size_t photons) const {
    return photons_for_caustic(known() > 0 ? known_caustic / known() : 0.5, photons);
}

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
