// Gather rays, and what they ask: maps of given photons.
#pragma once

#include "gather/gather_rays.h"

namespace keyhole {

class MappedGather {
  public:
    /// Refers to the scene and the patches.
    MappedGather(const Scene& scene, const SurfacePatches& patches, const PhotonSet& photons, LookupOptions options)
        : scene_(scene), patches_(patches), options_(options), global_(photons),
          irradiance_(global_.pilots(), global_.main_photons(),
                      {.k = options.nearest, .max_radius = options.max_radius, .patches = &patches, .scene = &scene},
                      {}),
          direct_(scene, irradiance_.places(), kMostFaces, {}, {}) {}

    GatherRays rays(const LobeTechniques* lobes = nullptr, const HotSpots* spots = nullptr) const {
        return {scene_,
                {.global = &global_,
                 .irradiance = &irradiance_,
                 .direct = &direct_,
                 .patches = &patches_,
                 .lobes = lobes,
                 .spots = spots},
                options_,
                8};
    }
    /// What a ray from a point in space along `w` finds.
    GatherRays::Arrival along(const Vec3& point, const Vec3& w, Rng& rng, const LobeTechniques* lobes = nullptr,
                              const HotSpots* spots = nullptr) const {
        Vertex from;
        from.point.site = Site::point;
        from.point.p = point;
        return rays(lobes, spots).trace(from, w, 1, 1, rng);
    }

  private:
    const Scene& scene_;
    const SurfacePatches& patches_;
    LookupOptions options_;
    PilotedMap global_;
    IrradianceMap irradiance_;
    DirectIrradianceCache direct_;
};

} // namespace keyhole
