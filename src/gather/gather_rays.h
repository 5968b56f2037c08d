// Gather rays: what arrives at a point along a ray, asked from the photon maps where the ray ends.
#pragma once

#include "gather/direct_irradiance_cache.h"
#include "gather/lobe_techniques.h"
#include "photonmap/irradiance/irradiance_map.h"
#include "photonmap/outlying_photons.h"
#include "photonmap/pilot_surroundings.h"
#include "sampling/paths/walk.h"

#include <algorithm>
#include <optional>

namespace keyhole {

class HotSpots;

/// What stage three asks. Maps may be null: nothing of that kind was found.
struct GatherMaps {
    const PilotedMap* global = nullptr;
    const IrradianceMap* irradiance = nullptr;     ///< of the global map
    const DirectIrradianceCache* direct = nullptr; ///< direct light where `irradiance` is known; null only if that is
    const PilotedMap* caustic = nullptr;
    const PilotSurroundings* caustic_surroundings = nullptr; ///< of its pilots; null only if that is
    const OutlyingPhotons* outlying = nullptr;               ///< of the caustic map; null: none
    const SurfacePatches* patches = nullptr;
    const GatherCoverage* coverage = nullptr; ///< where light is gathered: of the rest the caustic map knows; null: all
    /// How lobes are asked where rays end; null: by photons, as must be where there is coverage. A ray that is traced
    /// on may end beyond it, or where the photons of chains don't lie (Photons::everywhere).
    const LobeTechniques* lobes = nullptr;
    const HotSpots* spots = nullptr; ///< that rays which are traced on are aimed at; null: none
};

struct LookupOptions {
    int nearest = 60;     ///< photons in a radiance estimate
    float max_radius;     ///< of a lookup in the global map [m]
    float caustic_radius; ///< of a lookup in the caustic map [m]
    float shrink = 1;     ///< of lookup regions, as in PhotonQuery
    /// Roughness that glossy lobes have at least where gather rays end: what a narrow one sends to a few of a thousand
    /// rays is noise, and a wider one sends as much to more of them.
    double least_alpha = 0;
};

/// Variance of the luminance that a surface without a diffuse part sends along a gather ray [(W/(m^2 sr))^2], by either
/// of LobeTechniques: that of photons and of the direct light beside them, or of a ray more.
struct LobeNoise {
    double photons = 0, direct = 0, traced = 0;
};

/// Immutable and thread-safe. All arguments by reference or pointer must outlive it.
class GatherRays {
  public:
    GatherRays(const Scene& scene, const GatherMaps& maps, const LookupOptions& options, int max_scatterings)
        : scene_(scene), maps_(maps), options_(options), max_scatterings_(max_scatterings) {}

    /// What comes along a ray [W/(m^2 sr)].
    struct Arrival {
        Rgb indirect{0.0}; ///< reflected by what the ray met
        Rgb emitted{0.0};  ///< emitted by what it met first, weighted against next_event() at the ray's origin
        Rgb lamps{0.0};    ///< emitted by large lamps, and come here by specular vertices that turned it
        float distance = std::numeric_limits<float>::infinity(); ///< to what it met first [m]
        /// Luminance of what of `indirect` could go by longer ways from the ray's origin to the eye than it does.
        LongerWays reaching{};
    };
    /// Follows the ray from `from` along `w`, which was drawn with density `pdf` per solid angle. `scatterings` counts
    /// those between the eye and the ray.
    Arrival trace(const Vertex& from, const Vec3& w, double pdf, int scatterings, SampleSource& source) const;

    /// Radiance towards `back` that the caustic map gives at a visible point, which reflects so much luminance besides.
    /// Where the surface is so fine that a lookup takes many rays, and the caustic is the lesser part, it is looked at
    /// by chance, and counts all the more then. `scatterings` counts those between the eye and here, this one included.
    Rgb caustic(const Vertex& v, const Vec3& back, double besides, int scatterings, SampleSource& source) const;
    /// Share of its luminance that pilot photons don't confirm (unconfirmed_share()).
    double unconfirmed_caustic(const Vertex& v, const Vec3& back) const;

    /// At `v`, without a diffuse part, where a ray met it; by samples of both. None where no photons are near. Only
    /// where there is an irradiance map.
    std::optional<LobeNoise> lobe_noise(const Vertex& v, const Vec3& back, int scatterings, SampleSource& source) const;

    const Scene& scene() const { return scene_; }
    int max_scatterings() const { return max_scatterings_; }
    /// Of clear glass that may stand between emitters and the last of so many scatterings from the eye on.
    int faces_left(int scatterings) const { return std::clamp(max_scatterings_ - scatterings, 0, kMostFaces); }

  private:
    /// Of light that comes on the side of `normal`.
    Rgb caustic_on_side(const Vertex& v, const Vec3& normal, const Vec3& back, double besides, int longer,
                        SampleSource& source) const;
    /// Of the photons that light regions of their own.
    Rgb outlying_on_side(const Vertex& v, const Vec3& normal, const Vec3& back, int longer) const;
    /// With which probability a caustic is worth a look; 0 where there is none.
    double chance_of_caustic(const Vertex& v, const Vec3& back, const SurfaceRegion& region, float r,
                             double besides) const;
    /// Where a ray comes from, as far as what it meets depends on that.
    struct Leg {
        float distance;  ///< from the vertex before [m]
        int scatterings; ///< between the eye and the vertex that it leads to
        int traced_on;   ///< rays before it, each traced on from where the last one ended

        /// Vertices between the eye and the one it led to, d2, beyond d1.
        int longer() const { return scatterings - 1; }
    };
    struct Walk;
    Arrival trace(const Vertex& from, const Vec3& w, double pdf, const Leg& start, SampleSource& source) const;
    /// Of direct light where a leg ends.
    LightSamples at_end(const Leg& leg) const;
    /// Whether what the estimate at the place of the middle of a region, if it has one, says of that isn't good enough
    /// for a ray from `leg.distance` away, so that it has to be traced on.
    bool goes_on(const Leg& leg, const std::optional<std::uint32_t>& place, const SurfaceRegion& here) const;
    /// Whether the surface around a place is finer than the estimate there.
    bool is_fine(std::uint32_t place) const;
    /// What is known of where a ray ended.
    struct End {
        std::optional<std::uint32_t> place{}; ///< of the irradiance map
        Rgb direct{0.0};                      ///< of what the diffuse part reflects there, what emitters bring
    };
    /// Radiance towards `back` that `v` reflects by its finite part.
    Rgb reflected(Vertex& v, const Vec3& back, const Leg& leg, SampleSource& source, End& end) const;
    /// Adds `light`, which was found at `end`, to what comes along a ray.
    void add(const Rgb& throughput, const Rgb& light, const End& end, const Leg& leg, Arrival& arrival) const;
    /// What `v`, at which the irradiance is about `irradiance` [W/m^2], reflects of indirect light that comes along a
    /// ray more. `next`: the leg that this begins.
    Rgb bounced(const Vertex& v, const Vec3& back, const Rgb& irradiance, const Leg& next, SampleSource& source) const;
    /// The same with the caustics that photons tell of near `place`, if `v` has one.
    Rgb traced_on(const Vertex& v, const Vec3& back, const std::optional<std::uint32_t>& place, const Rgb& irradiance,
                  const Leg& leg, SampleSource& source) const;
    /// Irradiance that emitters bring, weighed as the diffuse part weighs it: that of the place, if it does for `v`.
    Rgb direct(const std::optional<std::uint32_t>& place, const Vertex& v, const SurfaceRegion& here, const Leg& leg,
               SampleSource& source) const;
    /// A vertex with a part of its BSDF, no narrower than LookupOptions::least_alpha.
    struct Widened {
        Vertex v;
        double scale; ///< of what it reflects
    };
    Widened widened(const Vertex& v, const Bsdf& part, const Vec3& back) const;
    /// What `v`, without a diffuse part, reflects, by the technique that is the better one there.
    Rgb lobe(const Vertex& v, const Vec3& back, const std::optional<std::uint32_t>& place, const Leg& leg,
             SampleSource& source) const;
    /// By one more ray; caustics are told by photons.
    Rgb lobe_traced_on(const Vertex& v, const Vec3& back, const std::optional<std::uint32_t>& place, const Leg& leg,
                       SampleSource& source) const;
    /// Whether something may stand on a region near a place, which has the radius of that, and hide photons there.
    bool may_be_partly_occluded(std::uint32_t place, const SurfaceRegion& region) const;
    /// What the global map says of light that `v` reflects towards `back`.
    Rgb global(const Vertex& v, const Vec3& back, int longer) const;
    /// Which of the photons near a place count.
    struct Asked {
        bool caustics; ///< these alone
        int longer;    ///< those that may reach the eye by so many vertices more than the fewest: Photon::spare()
    };
    /// Area [m^2] over which photons near a place are counted; 0 where that isn't known.
    double area_near(std::uint32_t place, const SurfaceRegion& region) const;
    /// The same as global() of these that come on the side of `normal`, near a place of the irradiance map, whose
    /// radius and surface do for `v`, too.
    Rgb photons(Asked asked, std::uint32_t place, const Vertex& v, const Vec3& normal, const Vec3& back,
                SampleSource& source) const;
    /// The place near `v` for light on the side of `normal`.
    std::optional<std::uint32_t> place_at(const Vertex& v, const Vec3& normal) const;
    /// photons() on the sides of `v` that its BSDF takes light from. `near`: the place on the side of `back`.
    Rgb photons_on_each_side(Asked asked, const std::optional<std::uint32_t>& near, const Vertex& v, const Vec3& back,
                             SampleSource& source) const;
    /// Their variance, as far as it is that of the photons [(W/(m^2 sr))^2].
    double variance_of_photons(const Vertex& v, const Vec3& back) const;

    const Scene& scene_;
    GatherMaps maps_;
    LookupOptions options_;
    int max_scatterings_;
};

} // namespace keyhole
