#include "photonmap/importance/importance_map.h"

#include "sampling/paths/measure.h"

#include <algorithm>

namespace keyhole {
namespace {

/// An estimate holds as far from its place as this times its radius.
constexpr float kReach = 2;

} // namespace

ImportanceMap::Importance ImportanceMap::importance(const SurfacePoint& d2, const Bsdf& bsdf, const Vec3& to_light,
                                                    Ways ways, int longest) const {
    const PhotonQuery query{{d2.p, facing(d2.ng, to_light)}, options_.max_radius, options_.k};
    const auto scattering = [&](const Photon& importon) {
        if (ways == Ways::specular && !importon.caustic()) return Rgb(0.0);
        if (importon.spare() > longest) return Rgb(0.0);
        return scatter(d2, bsdf, Event::finite, to_light, importon.direction()).value;
    };
    const DensityEstimate e = estimate_density(map_, query, options_.unbiased, options_.patches, scattering);
    // With few importons the reciprocal of n has a heavy tail; that of n + 1 has the right expectation for a Poisson
    // count.
    const bool few = e.photons > 0 && e.photons < options_.k;
    const bool obstructed = options_.patches != nullptr && options_.patches->obstructed(query.region, e.radius);
    return {few ? e.value * (1 + 1.0 / e.photons) : e.value, e.photons, obstructed};
}

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
