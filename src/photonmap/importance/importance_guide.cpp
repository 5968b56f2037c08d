#include "photonmap/importance/importance_guide.h"

namespace keyhole {

std::vector<Photon> ImportanceGuide::some(const PhotonMap& importons) {
    std::vector<Photon> chosen;
    chosen.reserve(importons.photons().size() / kPilotEvery + 1);
    for (std::uint32_t i = 0; i < importons.photons().size(); i += kPilotEvery) chosen.push_back(importons[i]);
    return chosen;
}

std::optional<double> ImportanceGuide::visible_power(const Vertex& v, const Vec3& to_light, const Rgb& power) const {
    const auto answer = map_.irradiance(v.point.p, facing(v.point.ng, to_light));
    if (!answer.known) return std::nullopt;
    // Where light leaves is not known here: a diffuse part doesn't mind, and what a glossy one reflects in all is taken
    // to leave evenly.
    const Rgb scattering = v.bsdf.diffuse_reflectance(to_light) * v.bsdf.diffuse_weight(to_light) +
                           Rgb(v.bsdf.glossy_albedo(to_light) / kPi);
    const double visible = luminance(power * scattering * answer.irradiance);
    if (!(visible > 0)) return std::nullopt;
    return visible;
}

} // namespace keyhole
