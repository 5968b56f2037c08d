#include "photonmap/photon_weighing.h"

#include "photonmap/map_stores.h"

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

} // namespace keyhole
