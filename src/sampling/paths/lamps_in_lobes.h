// Lamps that a narrow lobe at a visible point shows by way of curved glass and mirrors: L S+ D1 S* E with the glossy
// part of D1. Two techniques can have that light. Photons of the caustic map are few in a narrow lobe, and what they
// tell is noise as wide as a lookup; a ray drawn from the lobe meets a lamp often if it is large. Which of the two
// counts a path follows from the path alone, so that each counts once (docs/gather.md, "Lamps in narrow lobes").
#pragma once

#include "scene/bsdf.h"
#include "scene/scene.h"

namespace keyhole {

/// Solid angle [sr] that a lobe must not exceed to be narrow, and one that a lamp must not fall below, as seen from the
/// eye, to be large. Both move noise alone: error of a counter's caustics with 0.03 for both over that with these, 11
/// for a lobe of 0.126 sr, 14 for a lamp of 0.0044 sr.
constexpr double kNarrowLobe = 0.13, kLargeLamp = 0.004;

/// Whether `lobe`, the glossy part of a BSDF, is narrow as it is seen along `back`: by its density at the mirror
/// direction. With GGX straight on that is 1 / (4 pi alpha^2), so that alpha is 0.1 at most.
inline bool is_narrow(const Bsdf& lobe, const Vec3& back) {
    const Vec3 n = lobe.shading_normal();
    const Vec3 mirrored = n * (2 * n.dot(back)) - back;
    return lobe.pdf(back, mirrored) * kNarrowLobe >= 1;
}

/// Whether the emitter at its point `x0` is large: by the density with which it draws that point, so that the sun in a
/// picture of a sky isn't while the sky around it is. Nothing meets an emitter without extent.
inline bool is_large_lamp(const Scene& scene, const SurfacePoint& x0) {
    const Emitter& emitter = scene.emitter(x0.emitter);
    if (emitter.is_delta()) return false;
    const double pdf = emitter.point_pdf(x0);
    if (x0.site == Site::infinite) return pdf * kLargeLamp <= 1;
    // Of an area, half is what is seen of it, on average.
    const double away = (x0.p - scene.camera().parameters().origin).length2();
    return pdf * kLargeLamp * 2 * away <= 1;
}

} // namespace keyhole
