// Stage three: what the eye sees, from direct light, the caustic map, and gather rays or their cached irradiance.
#pragma once

#include "core/pixel_sample.h"
#include "gather/direct_light.h"
#include "gather/gather_rays.h"
#include "gather/irradiance_cache.h"
#include "gather/spots/aimed_ray.h"

#include <atomic>

namespace keyhole {

/// At each visible point.
struct GatherSamples {
    int light;   ///< of emitters
    double rays; ///< gather rays where the cache doesn't serve, rounded; where it does the glossy part's share of them
};

/// Thread-safe; immutable but for what it counts. All arguments by reference or pointer must outlive it.
class FinalGather {
  public:
    /// `cache` may be null: gather rays from every sample. So may `spots`, which gather rays are aimed at, too.
    FinalGather(const GatherRays& rays, const IrradianceCache* cache, const HotSpots* spots,
                const GatherSamples& samples)
        : scene_(rays.scene()), rays_(rays), cache_(cache), spots_(spots), samples_(samples) {}

    /// Estimates what arrives at the eye through window point `image`. Unbiased but for the maps and the cache.
    PixelSample sample(const Vec2& image, SampleSource& source) const;

    /// Luminance of a sample [W/(m^2 sr)], and what is doubtful of it.
    struct Doubts {
        double all = 0;
        double unconfirmed = 0; ///< of caustics, by pilot photons (unconfirmed_share()), where they were asked
        double of_records = 0;  ///< standard error of the cached irradiance in it, by the records' first rays
        int rays = 0;           ///< gather rays that were drawn for it, apart from those aimed at spots
    };
    /// Draws a sample and asks pilot photons about it, if `confirm`.
    Doubts doubt(const Vec2& image, bool confirm, SampleSource& source) const;

    /// Share of the questions to the cache, by all samples so far, that it had no record for; 0 before any.
    double starving() const {
        return asked_ > 0 ? static_cast<double>(unanswered_) / static_cast<double>(asked_) : 0.0;
    }

  private:
    /// A sample in the making.
    struct Sample : PixelSample {
        bool confirm = false;   ///< whether to ask pilot photons
        double unconfirmed = 0; ///< luminance of caustics that they don't confirm
        double of_records = 0;  ///< standard error of the cached part of its luminance
        int rays = 0;           ///< gather rays
    };
    /// A walk from the eye by specular events. At the first glass or coat on its way all of these are followed.
    struct EyeWalk;
    /// Everything that the finite scattering at the last two vertices seen does: direct light, caustic, gather rays.
    void shade(const Vertex& v, const Vec3& back, const Rgb& throughput, int scatterings, SampleSource& source,
               Sample& out) const;
    void draw(const Vec2& image, SampleSource& source, Sample& out) const;
    /// What the diffuse part reflects towards `back` by cached irradiance.
    struct Cached {
        Rgb radiance{0.0};
        double error = 0; ///< standard error of its luminance
    };
    /// None where there is no such part or no such record.
    std::optional<Cached> ask_cache(const Vertex& v, const Vec3& back, int scatterings) const;

    struct Light {
        Rgb direct, indirect;
        Rgb lamps{0.0}; ///< caustics, of which the photons of the caustic map have the rest
        int rays = 0;   ///< gather rays that were drawn for it
        Light& operator+=(const Light& o) {
            direct += o.direct;
            indirect += o.indirect;
            lamps += o.lamps;
            rays += o.rays;
            return *this;
        }
    };
    /// By gather rays; what they meet of emitters is direct light, by MIS against next_event().
    Light gather_all(const Vertex& v, const Vec3& back, int scatterings, SampleSource& source) const;
    /// All direct light, and indirect light that the glossy part reflects, by gather rays drawn from that part. For
    /// direct light these stand for the samples of the BSDF that would come from it.
    /// @param besides what the diffuse part reflects of indirect light
    Light gather_glossy(const Vertex& v, const Vec3& back, const Rgb& besides, int scatterings,
                        SampleSource& source) const;

    /// What a lobe reflects of indirect light along a ray that is aimed at hot spots.
    Rgb gather_aimed(const AimedRay& aimed, const Vertex& v, const Bsdf& lobe, const Vec3& back, int scatterings,
                     SampleSource& source) const;

    LightSamples light_samples(int scatterings) const { return {samples_.light, rays_.faces_left(scatterings)}; }

    const Scene& scene_;
    const GatherRays& rays_;
    const IrradianceCache* cache_;
    const HotSpots* spots_;
    GatherSamples samples_;
    // Apart from what every thread reads all the time.
    alignas(64) mutable std::atomic<std::uint64_t> asked_ = 0;
    mutable std::atomic<std::uint64_t> unanswered_ = 0;
};

} // namespace keyhole
