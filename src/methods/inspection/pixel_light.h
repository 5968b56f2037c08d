// Where the light of pixels comes from.
#pragma once

#include "gather/gather_rays.h"
#include "photonmap/irradiance/irradiance_map.h"
#include "sampling/guidance/learned/learned_direct_light.h"

#include <cstdint>
#include <vector>

namespace keyhole {

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

} // namespace keyhole
