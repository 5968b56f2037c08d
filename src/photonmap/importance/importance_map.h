// The visual importance of light that arrives at a surface, estimated from importons.
#pragma once

#include "photonmap/density_estimate.h"
#include "photonmap/irradiance/irradiance_map.h"
#include "sampling/paths/path.h"
#include "scene/bsdf.h"
#include "scene/surface_point.h"

namespace keyhole {

struct ImportanceOptions {
    int k = 50;                               ///< importons in an estimate
    float max_radius;                         ///< [m]; bounds how far importance can leak
    Unbiased unbiased = Unbiased::reciprocal; ///< photon power divides by importance
    const SurfacePatches* patches = nullptr;  ///< measure areas; null: the disc's, which makes E
                                              ///< too small at edges. Must outlive the map.
};

/// Ways from the eye to a place.
enum class Ways {
    all,
    specular ///< by way of specular vertices
};

/// Immutable and thread-safe.
class ImportanceMap {
  public:
    ImportanceMap(std::vector<Photon> importons, const ImportanceOptions& options)
        : map_(std::move(importons)), options_(options) {}

    struct Importance {
        Rgb value{0.0};    ///< E, [1/W] up to the scale of the importons' power
        int importons = 0; ///< found; 0 means that nothing is known here, not that E is zero
        /// Whether something stands on the surface that they lie on: importance may have come from behind it.
        bool obstructed = false;

        /// Whether a power may be divided by it: enough importons say so, none that a wall may hide, on a surface where
        /// they can tell; a glossy lobe sees few of them, however many there are.
        bool trusted(const Bsdf& bsdf) const {
            const BsdfTraits traits = bsdf.traits();
            return importons >= 16 && !obstructed && traits.diffuse && !traits.glossy;
        }
    };

    /// E(d2, to_light) = integral of fs(d2) G(d2, d1) fs(d1) ... over all ways on to the eye: the sum over importons
    /// near `d2` of scattering from `to_light` (unit, away from the surface) into the importon's direction, times its
    /// importance, over the area. `bsdf` is that at `d2`; `ways` which importons count: of them, those whose way is
    /// longer than the shortest by `longest` vertices at most (Photon::spare()).
    ///
    /// Importance arrives through the geometric surface, so the scattering carries the shading-normal factor
    /// |wi.ns| / |wi.ng| at d2, as a path's vertex value does (measure.h): E times the photon's own f is then the
    /// contribution of the path. Only importons on the side of `to_light` count, since finite BSDFs only reflect.
    Importance importance(const SurfacePoint& d2, const Bsdf& bsdf, const Vec3& to_light, Ways ways = Ways::all,
                          int longest = PhotonPast::kMostSpare) const;

    const PhotonMap& map() const { return map_; }
    std::size_t bytes() const { return map_.bytes(); }

  private:
    PhotonMap map_;
    ImportanceOptions options_;
};

/// A cheap picture of where photons will be asked for: it steers, and never enters a photon's power. Importance of
/// light at a surface, estimated beforehand at some importons (Christensen 1999, on the adjoint) and read from the
/// nearest of them: a tenth of the time of ImportanceMap, and as rough. Immutable and thread-safe.
class ImportanceGuide {
  public:
    /// `importons` is only read here. `scene`, which must outlive the guide, is for walls that hide importons; without
    /// one importance may leak past them.
    ImportanceGuide(const PhotonMap& importons, float max_radius, const SurfacePatches& patches, const Scene* scene,
                    const RunContext& context)
        : places_(some(importons), PhotonMap::Wanted::one),
          map_(places_, importons,
               {.k = 30, .max_radius = max_radius, .patches = &patches, .most_hidden = kMostHidden, .scene = scene},
               context) {}
    ImportanceGuide(const ImportanceGuide&) = delete; // map_ refers to places_
    ImportanceGuide& operator=(const ImportanceGuide&) = delete;

    /// Luminance that the picture gains, on average over its window, from light of RGB `power` [W] that arrives at `v`
    /// from `to_light`: about Y(power E). None where no importon is near: nothing is known there.
    std::optional<double> visible_power(const Vertex& v, const Vec3& to_light, const Rgb& power) const;

    std::size_t bytes() const { return places_.bytes() + map_.bytes(); }

  private:
    /// Behind the outer faces of walls a lookup finds one hidden importon after the other: rays that are better spent
    /// on light paths. Where that many are hidden nothing is known, and photons share what is kept for such places.
    static constexpr int kMostHidden = 4;

    /// Importons that stand in for pilot photons. They count as main photons as well, which a guide can afford.
    static std::vector<Photon> some(const PhotonMap& importons);

    PhotonMap places_;
    IrradianceMap map_;
};

} // namespace keyhole
