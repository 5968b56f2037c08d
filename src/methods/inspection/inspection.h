// What `keyhole inspect` shows of a scene: a quick render, and everything that it was made from.
#pragma once

#include "gather/gather_rays.h"
#include "methods/photons/pass_gather.h"
#include "methods/render.h"
#include "photonmap/irradiance/irradiance_map.h"
#include "sampling/guidance/learned/learned_direct_light.h"
#include "sampling/guidance/user_paths.h"
#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

namespace keyhole {

/// A scene's surfaces as one mesh of coloured triangles that a browser can hold.
struct SurfaceMesh {
    using Triangle = std::array<std::uint32_t, 3>;

    std::vector<Vec3> positions;
    std::vector<std::array<std::uint8_t, 3>> colours; ///< of positions: what the surface reflects, sRGB
    std::vector<Triangle> triangles;     ///< opaque ones, then emitters, then those that light goes through
    std::size_t emitters = 0, clear = 0; ///< where the latter two begin
    std::size_t of_scene = 0;            ///< triangles that the scene has
};

/// Shapes that have too many triangles for their share of `most` are simplified: corners in the same cell of a grid
/// become one (Rossignac and Borrel 1993), or where that leaves nothing some are shown. None vanishes: of each shape
/// there is a triangle, and there are 2 `most` and one of each shape at most. Emitters stay as they are as long as they
/// have few.
SurfaceMesh surface_mesh(const Scene& scene, std::size_t most);

/// What a pixel's middle sees, and what arrives there.
struct PixelLight {
    /// A place that light comes from.
    struct Source {
        Vec3 p;      ///< world space
        float value; ///< luminance that it adds to the pixel, by one of the samples [W/(m^2 sr)]; 0: nothing
    };
    /// The end of a gather ray. Of the light that is scattered there part came straight from an emitter.
    struct GatherEnd : Source {
        Vec3 lamp{0, 0, 0};                          ///< a point on an emitter, by one sample; drawn at a distance
        float from_lamp = 0;                         ///< what that part adds to the pixel [W/(m^2 sr)]; 0: nothing
        std::uint32_t emitter = SurfacePoint::kNone; ///< that it comes from
    };
    std::vector<Vec3> trail;       ///< from the eye by way of mirrors and glass; the last is the first other surface
    bool seen = false;             ///< whether there is one: otherwise the trail leads nowhere, or to an emitter
    std::vector<GatherEnd> gather; ///< ends of gather rays: light that was scattered there
    std::vector<Source> direct;    ///< points on emitters that are in sight
    /// Where shadow rays go: the likeliest emitters, as was learned, or, where nothing was, by the light tree. None
    /// where there is no choice, or too large a one.
    std::vector<EmitterChance> lamps;
    float reach = 0; ///< radius of the estimate from photons there [m]; 0: none
};

struct PixelLightOptions {
    int gather = 12, direct = 4; ///< samples of each
    std::uint64_t seed;
    const LearnedDirectLight* learned = nullptr; ///< null: nothing
    std::size_t lamps = 3;                       ///< most that are told
    int towards = 6;                             ///< most directions of each
};

/// Of all pixels, row by row. The same on any number of threads.
std::vector<PixelLight> pixel_lights(const GatherRays& rays, const IrradianceMap* irradiance,
                                     const PixelLightOptions& options);

/// A main photon of a map.
struct PhotonShown {
    Photon photon;
    bool caustic;                                ///< of the caustic map, else of the global one
    bool guided = false;                         ///< whether its path began along a user path
    int scatterings = -1;                        ///< before it arrived; -1: the sampler doesn't say
    std::uint32_t emitter = SurfacePoint::kNone; ///< that it comes from, where that is known
    bool gathered = true;                        ///< whether gather rays come there
    std::int32_t trail = -1;                     ///< index among the trails, where its whole path was kept
};

/// A whole path from the emitter on, which goes on to the eye where the sampler has such paths.
struct PhotonTrail {
    std::vector<TrailPoint> points;
    std::size_t photon = 0; ///< index of the point that the photon lies at

    bool operator==(const PhotonTrail&) const = default;
};

struct PhotonSample {
    struct Map {
        std::size_t main_photons = 0, pilots = 0;
        double power = 0; ///< luminous, of the main photons [W]
    };
    Map global, caustic;
    std::vector<PhotonShown> photons; ///< each stands for as many of its map as there are for one shown
    std::vector<PhotonTrail> trails;
    std::uint64_t refused = 0;    ///< arrivals that did not survive the roulette of the stores
    std::vector<Vec3> refused_at; ///< where, of some of these
};

/// Keeps what a page shows of the photons of a pass: a sample of them, and the paths that brought them. The same on any
/// number of threads: what is kept follows from the photons' places.
class PhotonRecorder {
  public:
    void stored(const Photon& photon, const PhotonOrigin& origin);
    void thrown_away(const Vec3& p);

    /// Of the photons that are left in the maps, at most `photons` with at most `trails` paths.
    PhotonSample sample(const Photons& maps, std::size_t photons, std::size_t trails);

  private:
    /// Where a photon lies and where its light came from, bit by bit: no two have the same.
    using Key = std::array<std::uint32_t, 6>;
    struct Origin {
        int scatterings = 0;
        std::uint32_t emitter = 0;
        bool guided = false;
        PhotonTrail trail{}; ///< empty: not kept

        bool comes_before(const Origin& o) const;
    };
    struct Shard {
        std::mutex mutex;
        std::map<Key, Origin> origins;
        std::map<std::array<float, 3>, int> refused_at;
        std::uint64_t refused = 0;
    };
    static Key key_of(const Photon& photon);
    static std::uint64_t hash(const Key& key);
    void add(std::span<const Photon> photons, std::size_t most, bool caustic, PhotonSample& out);
    const Origin* origin_of(const Photon& photon);

    static constexpr std::size_t kShards = 64;
    static constexpr std::uint64_t kTrailsEvery = 3; ///< photons of which one has its whole path kept
    static constexpr std::uint64_t kRefusedEvery = 16;
    std::array<Shard, kShards> shards_;
};

/// How much of each is kept at most.
struct InspectionLimits {
    std::size_t photons = 100'000, trails = 20'000, importons = 20'000, records = 20'000, triangles = 300'000;
    std::size_t gather_rays = 200'000; ///< of all pixels together
};

struct Inspection {
    struct Importon {
        Vec3 p;
        float value; ///< luminance of its importance
        bool first;  ///< where the eye looks; else where light is scattered towards there
    };
    struct Record {
        Vec3 p, n;
        float radius;     ///< around which there is no need of another [m]
        float noise;      ///< standard error of its light, relative
        float irradiance; ///< luminance [W/m^2]
    };
    RenderResult render, again; ///< two, that differ in their seed: how far they differ is their error
    SurfaceMesh surface;
    PhotonSample photons;
    bool gathered_everywhere = true;   ///< else light where gather rays seldom come is only in the caustic map
    bool learned_direct_light = false; ///< whether lamps are chosen as was learned
    std::vector<PixelLight> pixels;    ///< of `render`, row by row
    std::vector<Importon> importons;
    std::size_t importon_count = 0; ///< that were traced for this, of which some may be left out
    std::vector<Record> records;
    std::size_t record_count = 0; ///< of the irradiance cache
};

/// Renders twice by a method that keeps photons, and looks at the first pass of the first render: photons, records and
/// the answers for pixels are those that its picture was made from. Sets the scene's window margin.
/// @throws InputError for a method that keeps no photons; Interrupted.
Inspection inspect_scene(Scene& scene, const Settings& settings, const UserPaths& paths, const InspectionLimits& limits,
                         const RunContext& context);

} // namespace keyhole
