// The secondary gather: rays that are traced on where what is known of their ends isn't good enough (Christensen 1999).
#include "gather/gather_rays.h"

#include "gather/spots/spot_mixture.h"
#include "sampling/paths/measure.h"

namespace keyhole {
namespace {

/// Rays that may be traced on one after the other, in crevices. Four make light there a little better, and rooms full
/// of small things noisier.
constexpr int kMostTracedOn = 2;

/// Area of the surface in reach of an estimate over that of the disc, below which it is a mean over slats, leaves or
/// legs: light changes across each of them, and a ray meets the side that it comes from.
constexpr double kFine = 0.5;

} // namespace

bool GatherRays::goes_on(const Leg& leg, const std::optional<std::uint32_t>& place, const SurfaceRegion& here) const {
    // Where the gather coverage ends, light from beyond it would be lost.
    if (leg.traced_on == kMostTracedOn || maps_.coverage != nullptr) return false;
    // That no photon came near doesn't mean that no light does.
    if (!place) return true;
    // Farther away than its estimate looks, the place is one of other surfaces, as beside a frame on which no photon
    // lies: they may have a hundred times the light.
    const bool near = maps_.irradiance->is_near(*place, here);
    // The estimate is a mean over its radius. Seen from nearer than that, as in corners, or on a surface that is finer,
    // the mean is not good enough.
    const bool seen_from_near = leg.distance < maps_.irradiance->radius(*place);
    if (leg.traced_on == 0) return !near || seen_from_near || is_fine(*place);
    // To trace paths further costs more noise than it removes error, but in crevices: there all estimates have the
    // light of the room before them.
    return seen_from_near && (!near || maps_.irradiance->is_in_crevice(*place));
}

bool GatherRays::is_fine(std::uint32_t place) const { return maps_.irradiance->area_share(place) < kFine; }

Rgb GatherRays::bounced(const Vertex& v, const Vec3& back, const Rgb& irradiance, const Leg& next,
                        SampleSource& source) const {
    const auto by_bsdf = [&](const auto& density) {
        const auto on = continue_walk(v, back, From::eye, source);
        if (!on || is_specular(on->event)) return Rgb(0.0);
        return on->weight * trace(v, on->w, on->pdf, next, source).indirect * (on->pdf / density(on->w, on->pdf));
    };
    if (maps_.spots == nullptr) return by_bsdf([](const Vec3& /*w*/, double pdf) { return pdf; });
    const SpotMixture mixture(*maps_.spots, v.point.p, facing(v.point.ng, back), luminance(irradiance));
    if (!(mixture.aimed() > 0) || source.next() >= mixture.aimed())
        return by_bsdf([&](const Vec3& w, double pdf) { return mixture.density(w, pdf); });
    const Vec3 w = mixture.sample(source);
    const ScatterValue s = scatter(v.point, v.bsdf, Event::finite, w, back);
    const double density = mixture.density(w, s.pdf_to_light);
    if (!(density > 0) || !(luminance(s.value) > 0)) return Rgb(0.0);
    return s.value * trace(v, w, density, next, source).indirect * (v.point.abs_cos(w) / density);
}

Rgb GatherRays::traced_on(const Vertex& v, const Vec3& back, const std::optional<std::uint32_t>& place,
                          const Rgb& irradiance, const Leg& leg, SampleSource& source) const {
    Rgb sum = bounced(v, back, irradiance, {0, leg.scatterings + 1, leg.traced_on + 1}, source);
    if (!place) return sum;
    // Light that specular vertices alone brought here is found by no ray.
    const SurfaceRegion here{v.point.p, facing(v.point.ng, back)};
    const bool known = maps_.irradiance->is_near(*place, here);
    if (known ? maps_.irradiance->has_caustics(*place) : scene_.traits().delta)
        sum += photons({true, leg.longer()}, *place, v, here.normal, back, source);
    return sum;
}

} // namespace keyhole
