#include "photonmap/importance/importance_guide.h"

#include <algorithm>

namespace keyhole {
namespace {

/// An estimate holds as far from its place as this times its radius.
constexpr float kReach = 2;

} // namespace

std::vector<Photon> ImportanceGuide::some(const PhotonMap& importons) {
    std::vector<Photon> chosen;
    chosen.reserve(importons.photons().size() / kPilotEvery + 1);
    for (std::uint32_t i = 0; i < importons.photons().size(); i += kPilotEvery) chosen.push_back(importons[i]);
    return chosen;
}

std::optional<double> ImportanceGuide::visible_power(const Vertex& v, const Vec3& to_light, const Rgb& power) const {
    const Vec3 side = facing(v.point.ng, to_light);
    // What goes through is wanted on the other side, too: the better of the two tells.
    auto answer = map_.irradiance(v.point, side);
    if (v.bsdf.traits().through) {
        const auto behind = map_.irradiance(v.point, -side);
        if (!answer.known || (behind.known && luminance(behind.irradiance) > luminance(answer.irradiance)))
            answer = behind;
    }
    if (!answer.known) return std::nullopt;
    // Where light leaves is not known here: a diffuse part doesn't mind, and what a glossy one reflects in all is taken
    // to leave evenly.
    const Rgb scattering = v.bsdf.diffuse_reflectance(to_light) * v.bsdf.diffuse_weight(to_light) +
                           Rgb(v.bsdf.glossy_albedo(to_light) / kPi);
    // Farther away a place nearer by would be expected if importance were as large: it goes by the distance to the
    // nearest one. On the outside of a wall that may be one of another surface, metres away.
    const float distance = (map_.places()[answer.place].position() - v.point.p).length();
    const double far = std::max(1.0f, distance / (kReach * map_.radius(answer.place)));
    const double visible = luminance(power * scattering * answer.irradiance) / (far * far);
    if (!(visible > 0)) return std::nullopt;
    return visible;
}

} // namespace keyhole
