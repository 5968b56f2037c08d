// From what a path tracer finds to the layers of a pixel.
#pragma once

#include "core/pixel_sample.h"
#include "sampling/path_tracer.h"

namespace keyhole {

/// Collects one path-traced sample. Paths of `elsewhere` are left out, and no walk goes on that could make only these.
struct PixelSink {
    enum class Elsewhere { nothing, stored };

    Elsewhere elsewhere = Elsewhere::nothing; ///< stored: chains sample PathSet::stored
    PixelSample pixel{};

    bool arrival(const EyeWalk& walk, const Rgb& /*throughput*/, int finite) {
        const Vertex& v = walk.back();
        if (walk.size() == 2) pixel.depth = Vec3(v.point.p - walk[0].point.p).length();
        if (finite == 0 && v.bsdf.traits().finite && pixel.normal.length2() == 0) {
            const Vec3 back = direction(v.point, walk[walk.size() - 2].point);
            const Vec3 n = v.bsdf.shading_normal();
            const Vec3 facing = n.dot(back) < 0 ? -n : n;
            pixel.normal = facing;
            pixel.albedo = v.bsdf.eval(facing, back) * kPi;
        }
        return elsewhere == Elsewhere::nothing || finite < 2;
    }

    void contribution(const EyeWalk& /*walk*/, const Vertex& /*x0*/, const Rgb& value, LightClass light) {
        if (elsewhere == Elsewhere::stored && in_set(light, PathSet::stored)) return;
        switch (light) {
        case LightClass::emission:
        case LightClass::direct:
            pixel.direct += value;
            break;
        case LightClass::caustic:
            pixel.caustic += value;
            break;
        case LightClass::second:
        case LightClass::indirect:
            pixel.indirect += value;
            break;
        }
    }
};

} // namespace keyhole
