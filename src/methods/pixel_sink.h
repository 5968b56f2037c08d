// From what a path tracer finds to the layers of a pixel.
#pragma once

#include "core/pixel_sample.h"
#include "film/splats.h"
#include "sampling/paths/path_tracer.h"
#include "sampling/paths/seen_surface.h"

namespace keyhole {

/// Collects one path-traced sample. Paths of `elsewhere` are left out, and no walk goes on that could make only these.
struct PixelSink {
    using LooksThroughGlass = std::true_type;
    using TakesEachEmitter = std::true_type;

    const PathSet* elsewhere = nullptr; ///< what chains sample; null: nothing
    PixelSample pixel{};
    bool saw_surface = false; ///< that is not specular

    bool arrival(const EyeWalk& walk, const Rgb& throughput, int finite) {
        if (finite == 0) see(walk.back(), walk[walk.size() - 2], throughput, walk.size() == 2);
        // Beyond d2 an emitter is direct light there, seen straight or through clear glass.
        return elsewhere == nullptr || finite < 2 || (finite == 2 && clear_glass(walk.back()) != ClearGlass::none);
    }

    void contribution(EyeWalk& walk, const Vertex& x0, const Rgb& value, LightClass light) {
        if (elsewhere == nullptr || !elsewhere->contains(light, [&] { return is_d2_covered(*elsewhere, walk, x0); }))
            add(value, light);
    }

    /// Notes what vertex `v` looks like from `before`, the one nearer to the eye. `throughput`: as note_seen_surface()
    /// has it.
    void see(const Vertex& v, const Vertex& before, const Rgb& throughput, bool first) {
        if (v.point.site == Site::infinite) return;
        if (first) pixel.depth = seen_depth(before.point, v.point);
        if (!v.bsdf.traits().finite || saw_surface) return;
        note_seen_surface(pixel, v, direction(v.point, before.point), throughput);
        saw_surface = true;
    }

    void add(const Rgb& value, LightClass light) {
        using Layer = SplatFilm::Layer;
        const Layer layer = SplatFilm::layer_of(light);
        (layer == Layer::direct ? pixel.direct : layer == Layer::caustic ? pixel.caustic : pixel.indirect) += value;
    }
};

} // namespace keyhole
