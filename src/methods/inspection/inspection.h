// What `keyhole inspect` shows of a scene: a quick render, and everything that it was made from.
#pragma once

#include "methods/inspection/photon_recorder.h"
#include "methods/inspection/pixel_light.h"
#include "methods/inspection/surface_mesh.h"
#include "methods/render.h"
#include "sampling/guidance/user_paths.h"

namespace keyhole {

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
