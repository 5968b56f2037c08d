#include "methods/lit_specular.h"

#include "core/rng.h"
#include "scene/geometry.h"
#include "scene/warp.h"

#include <algorithm>
#include <vector>

namespace keyhole {
namespace {

/// Rays from all emitters, and as many from all surfaces: a few hundredths of a second, where nothing is found.
constexpr std::size_t kRays = std::size_t{1} << 15;
/// From each emitter or surface; where that makes more than kRays nobody looks.
constexpr std::size_t kFewest = 4, kMost = 4096;

std::size_t rays_each(std::size_t count) { return std::clamp(kRays / count, kFewest, kMost); }

/// Boundaries of media, and black shapes, that a ray goes on behind.
constexpr int kMostPassed = 16;

/// Whether the first surface that light would notice may be specular.
bool goes_to_specular(const Scene& scene, const Emitter& emitter, SampleSource& source) {
    const SurfacePoint from = emitter.sample_point(source).point;
    const EmitterRay ray = emitter.sample_ray(from, source);
    SurfacePoint at = ray.origin;
    for (int i = 0; i < kMostPassed && ray.pdf > 0; ++i) {
        if (!scene.trace(at, ray.w, at) || at.site != Site::surface) return false;
        const BsdfTraits traits = at.material != nullptr ? at.material->bsdf(at).traits() : BsdfTraits{};
        if (traits.delta || traits.finite) return traits.delta;
    }
    return ray.pdf > 0;
}

SurfacePoint point_on(const Shape& shape, SampleSource& source) {
    const auto [u, u0, u1] = source.take<3>();
    if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) return sphere_point(*sphere, uniform_sphere(u0, u1));
    const auto count = static_cast<double>(triangle_count(shape));
    const auto triangle = static_cast<std::uint32_t>(std::min(u * count, count - 1));
    const Vec2 place = uniform_triangle(u0, u1);
    return triangle_point(shape, triangle, place.x, place.y);
}

/// Whether a place on a shape, which may be specular, is that and sees the emitter.
bool is_lit(const Scene& scene, const Shape& shape, const Emitter& emitter, SampleSource& source) {
    const SurfacePoint point = point_on(shape, source);
    if (!shape.material->bsdf(point).traits().delta) return false; // a place of a texture that isn't
    const SurfacePoint lamp = emitter.sample_point(source).point;
    const Vec3 w = direction(point, lamp);
    return !is_black(emitter.radiance(lamp, -w)) && scene.visible(point, lamp, w);
}

} // namespace

bool may_light_specular(const Scene& scene) {
    std::vector<const Emitter*> emitters;
    for (const auto& emitter : scene.emitters())
        if (emitter->is_delta() && emitter->power() > 0) emitters.push_back(emitter.get());
    std::vector<const Shape*> shapes;
    for (const Shape& shape : scene.shapes())
        if (shape.material != nullptr && shape.material->traits().delta && !is_invisible_light(shape))
            shapes.push_back(&shape);
    if (emitters.empty() || shapes.empty()) return false;
    const std::size_t pairs = emitters.size() * shapes.size();
    if (std::max(pairs, emitters.size()) > kRays / kFewest) return true;
    Rng rng(0, StreamPurpose::path_tracing, 0);
    for (const Emitter* emitter : emitters)
        for (std::size_t i = 0; i < rays_each(emitters.size()); ++i)
            if (goes_to_specular(scene, *emitter, rng)) return true;
    for (const Emitter* emitter : emitters)
        for (const Shape* shape : shapes)
            for (std::size_t i = 0; i < rays_each(pairs); ++i)
                if (is_lit(scene, *shape, *emitter, rng)) return true;
    return false;
}

} // namespace keyhole
