#include "gather/direct_irradiance.h"

#include "scene/bsdfs/diffuse.h"

#include <limits>

namespace keyhole {
namespace {

constexpr double kReach = 0.25;

/// A white Lambertian surface: what it reflects is its irradiance over pi.
Vertex white_vertex(const SurfacePoint& point, const Vec3& n) {
    Vertex v;
    v.point = point;
    v.point.ns = n;
    v.bsdf = Bsdf(Frame(n), DiffuseBsdf{Rgb(1.0)});
    return v;
}

/// Harmonic mean of the distances to emitters, by what they would bring if nothing stood in between.
class MeanDistance {
  public:
    explicit MeanDistance(const Vec3& from) : from_(from) {}

    void add(const SurfacePoint& emitter, const Rgb& value) {
        const double y = luminance(value);
        weight_ += y;
        if (emitter.site != Site::infinite) inverse_ += y / static_cast<double>((emitter.p - from_).length());
    }
    double get() const { return inverse_ > 0 ? weight_ / inverse_ : std::numeric_limits<double>::infinity(); }

  private:
    Vec3 from_;
    double weight_ = 0, inverse_ = 0;
};

} // namespace

DirectIrradiance direct_irradiance(const Scene& scene, const SurfacePoint& point, const Bsdf& bsdf, const Vec3& n,
                                   const LightSamples& samples, SampleSource& source) {
    const Vertex v = white_vertex(point, n);
    MeanDistance distance(point.p);
    const auto weight = [&](const SurfacePoint& emitter) { return bsdf.diffuse_weight(direction(point, emitter)); };
    Rgb sum(0.0);
    for (int i = 0; i < samples.number; ++i) {
        if (const auto light = sample_direct_light(scene, v, n, source)) {
            distance.add(light->x0.point, light->value);
            const Rgb clear = straight_transmittance(scene, point, light->x0.point, samples.most_faces);
            sum += clear * light->value * weight(light->x0.point);
        }
        sample_emission(scene, v, n, samples.most_faces, source, [&](const SurfacePoint& emitter, const Rgb& value) {
            distance.add(emitter, value);
            sum += value * weight(emitter);
        });
    }
    return {sum * (kPi / samples.number), static_cast<float>(kReach * distance.get())};
}

} // namespace keyhole
