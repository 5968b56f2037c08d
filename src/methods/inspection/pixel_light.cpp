#include "methods/inspection/inspection.h"

#include "core/parallel.h"
#include "gather/direct_light.h"
#include "sampling/paths/random_walk.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

/// Follows what is seen through mirrors and glass.
struct EyeTrail : SpecularWalkHooks {
    std::vector<Vec3>& trail;
    float far; ///< where what is infinitely far away is drawn [m]
    std::optional<Vertex> found{};
    Vec3 back{0, 0, 0};
    Rgb throughput{0.0};
    int scatterings = 0;
    LastTwoVertices vertices{};

    Vertex& place() { return vertices.place(); }
    bool arrive(const Vertex& v, const WalkRay& ray) {
        const bool infinite = v.point.site == Site::infinite;
        trail.push_back(infinite ? ray.last->p + ray.w * far : v.point.p);
        if (infinite) return false;
        ++scatterings;
        if (!v.bsdf.traits().finite) return true;
        found = v;
        back = -ray.w;
        throughput = ray.throughput;
        return false;
    }
};

class PixelTracer {
  public:
    PixelTracer(const GatherRays& rays, const IrradianceMap* irradiance, const PixelLightOptions& options)
        : rays_(rays), scene_(rays.scene()), irradiance_(irradiance), options_(options),
          far_((scene_.upper() - scene_.lower()).length()) {}

    PixelLight trace(const Vec2& image, Rng& rng) const {
        PixelLight out;
        const SurfacePoint eye = scene_.camera().eye(0.5, 0.5);
        out.trail.push_back(eye.p);
        EyeTrail walk{{}, out.trail, far_};
        random_walk(scene_, From::eye, eye_ray(scene_, eye, image), rays_.max_scatterings(), rng, walk);
        out.seen = walk.found.has_value();
        if (!out.seen) return out;
        gather(walk, rng, out);
        light(walk, rng, out);
        out.lamps = lamps(walk.found->point);
        if (irradiance_ != nullptr) {
            const auto answer = irradiance_->irradiance(walk.found->point, facing(walk.found->point.ng, walk.back));
            if (answer.known) out.reach = irradiance_->radius(answer.place);
        }
        return out;
    }

  private:
    void gather(const EyeTrail& walk, Rng& rng, PixelLight& out) const {
        for (int i = 0; i < options_.gather; ++i) {
            PixelLight::GatherEnd source{{walk.found->point.p, 0}};
            const auto next = continue_walk(*walk.found, walk.back, From::eye, rng);
            if (next && !is_specular(next->event)) {
                const auto arrival = rays_.trace(*walk.found, next->w, next->pdf, walk.scatterings, rng);
                source.value = static_cast<float>(luminance(walk.throughput * next->weight * arrival.indirect));
                source.p += next->w * (std::isfinite(arrival.distance) ? arrival.distance : far_);
                if (source.value > 0) light_end(walk, *next, rng, source);
            }
            if (!std::isfinite(source.value)) source.value = 0;
            out.gather.push_back(source);
        }
    }
    /// Direct light where a gather ray ends, if that is where it is scattered, and not behind a mirror or glass.
    void light_end(const EyeTrail& walk, const Continuation& ray, Rng& rng, PixelLight::GatherEnd& end) const {
        const auto hit = next_vertex(scene_, *walk.found, ray.w);
        if (!hit || hit->point.site != Site::surface || !hit->bsdf.traits().finite) return;
        const auto drawn = sample_direct_light(scene_, *hit, -ray.w, rng);
        if (!drawn) return;
        const Rgb clear =
            straight_transmittance(scene_, hit->point, drawn->x0.point, rays_.faces_left(walk.scatterings + 1));
        const double value = luminance(walk.throughput * ray.weight * clear * drawn->value);
        if (!(value > 0) || !std::isfinite(value)) return;
        end.from_lamp = static_cast<float>(value);
        end.emitter = drawn->x0.point.emitter;
        end.lamp = place_of(drawn->x0.point, hit->point);
    }
    /// Where a point on an emitter is drawn that is seen from `from`.
    Vec3 place_of(const SurfacePoint& x0, const SurfacePoint& from) const {
        return x0.site == Site::infinite ? from.p + direction(from, x0) * far_ : x0.p;
    }
    void light(const EyeTrail& walk, Rng& rng, PixelLight& out) const {
        const Vertex& v = *walk.found;
        for (int i = 0; i < options_.direct; ++i) {
            PixelLight::Source source{v.point.p, 0};
            const auto drawn = sample_direct_light(scene_, v, walk.back, rng);
            const int faces = rays_.faces_left(walk.scatterings);
            const Rgb clear = drawn ? straight_transmittance(scene_, v.point, drawn->x0.point, faces) : Rgb(0.0);
            if (!is_black(clear)) {
                source.p = place_of(drawn->x0.point, v.point);
                source.value = static_cast<float>(luminance(walk.throughput * clear * drawn->value));
            }
            if (!std::isfinite(source.value)) source.value = 0;
            out.direct.push_back(source);
        }
    }

    std::vector<EmitterChance> lamps(const SurfacePoint& at) const {
        constexpr std::size_t kMost = 64; // which the light tree is asked for, one by one
        const std::size_t count = scene_.emitters().size();
        std::vector<EmitterChance> list;
        if (options_.learned != nullptr) list = options_.learned->chances(at, options_.towards);
        if (list.empty() && count > 1 && count <= kMost)
            for (std::uint32_t i = 0; i < count; ++i) list.push_back({i, scene_.light_tree().probability(at, i)});
        std::ranges::stable_sort(list, std::greater<>(), &EmitterChance::probability);
        if (list.size() > options_.lamps) list.resize(options_.lamps);
        return list;
    }

    const GatherRays& rays_;
    const Scene& scene_;
    const IrradianceMap* irradiance_;
    PixelLightOptions options_;
    float far_;
};

} // namespace

std::vector<PixelLight> pixel_lights(const GatherRays& rays, const IrradianceMap* irradiance,
                                     const PixelLightOptions& options) {
    const ImageWindow& window = rays.scene().camera().window();
    const PixelTracer tracer(rays, irradiance, options);
    std::vector<PixelLight> lights(static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height));
    parallel_for(window.height, [&](std::int64_t y) {
        for (int x = 0; x < window.width; ++x) {
            const auto pixel = static_cast<std::size_t>(y * window.width + x);
            Rng rng(options.seed, StreamPurpose::inspection, pixel);
            const Vec2 middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            lights[pixel] = tracer.trace(window.to_window(middle), rng);
        }
    });
    return lights;
}

} // namespace keyhole
