// What the BSDFs have in common: kinds of events, and what sampling returns.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace keyhole {

/// A colour as models keep it: half the size, and trivially copyable, which Imath's are not; with that, copying a path
/// needn't ask each vertex for the kind of its model.
struct StoredRgb {
    float x = 0, y = 0, z = 0;

    StoredRgb() = default;
    StoredRgb(const Rgb& c) : x(static_cast<float>(c.x)), y(static_cast<float>(c.y)), z(static_cast<float>(c.z)) {}
    operator Rgb() const { return {x, y, z}; }
};

/// How light goes on at a vertex. `finite` is D of the path notation; the other two are S.
enum class Event : std::uint8_t { finite, reflect, transmit };

inline bool is_specular(Event e) { return e != Event::finite; }

/// A direction drawn by a BSDF, in the frame of the arguments it was drawn with.
struct BsdfSample {
    Vec3 to; ///< unit, away from the surface
    Event event;
    double pdf; ///< finite: density per solid angle; specular: probability of this event
};

/// One delta lobe seen from a given direction.
struct DeltaScatter {
    Vec3 to;            ///< where light that comes from (or goes to) `from` goes to (or comes from)
    Rgb coefficient;    ///< fraction of the power that takes this lobe; the same from either side
    double probability; ///< with which sample() takes this event
    double eta;         ///< refractive index on the side of `to` over that on the side of `from`; 1 for reflection
};

/// The direction that a smooth surface reflects `w` to.
inline Vec3 mirrored(const Vec3& w) { return {-w.x, -w.y, w.z}; }

/// A direction drawn by a finite part with that density; none where it has none.
inline std::optional<BsdfSample> finite_sample(const Vec3& to, double pdf) {
    if (!(pdf > 0)) return std::nullopt;
    return BsdfSample{to, Event::finite, pdf};
}

/// Smooth glass, by what it does to light that goes through.
enum class ClearGlass : std::uint8_t {
    none, ///< it isn't that, or light goes on elsewhere
    face, ///< light is turned, and turned back by a parallel face
    pane, ///< light goes straight on
};

/// What the renderer may leave out for a BSDF that lacks it.
struct BsdfTraits {
    bool finite = false;  ///< has a D part: diffuse, glossy, or both
    bool delta = false;   ///< has S parts
    bool diffuse = false; ///< of its finite part something follows from irradiance alone: Bsdf::diffuse_reflectance()
    bool glossy = false;  ///< and something doesn't
    bool through = false; ///< its finite part sends light through the surface
    ClearGlass clear = ClearGlass::none; ///< the clearest glass that it may be, where it is flat

    /// What either has.
    friend constexpr BsdfTraits operator|(const BsdfTraits& a, const BsdfTraits& b) {
        return {a.finite || b.finite, a.delta || b.delta,     a.diffuse || b.diffuse,
                a.glossy || b.glossy, a.through || b.through, std::max(a.clear, b.clear)};
    }
};

} // namespace keyhole
