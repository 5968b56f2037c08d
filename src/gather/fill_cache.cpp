#include "gather/fill_cache.h"

#include "core/parallel.h"

#include <algorithm>
#include <numeric>

namespace keyhole {
namespace {

constexpr int kCoarsest = 16;      // [pixels] between the points of the first level
constexpr std::size_t kBatch = 64; // records computed at once
constexpr double kCovered = 0.1;   // sum of weights below which a point needs a record of its own

struct Candidate {
    Vertex vertex;
    Vec3 back;       ///< unit
    double pixel;    ///< width of a pixel there [m]
    int scatterings; ///< from the eye, this one included
};

/// The near-Lambertian point that is seen at `image`, by specular events chosen at random.
std::optional<Candidate> visible_point(const GatherRays& rays, const Vec2& image, SampleSource& source) {
    const Scene& scene = rays.scene();
    const Camera& camera = scene.camera();
    Vertex v = sample_eye(scene, source);
    Vec3 w = camera.ray_direction(v.point, image);
    const double pixel = 1 / std::sqrt(camera.direction_pdf(w) * camera.window().pixels());
    double length = 0;
    for (int scatterings = 1; scatterings <= rays.max_scatterings(); ++scatterings) {
        const auto hit = next_vertex(scene, v, w);
        if (!hit || hit->point.site == Site::infinite) break;
        length += (hit->point.p - v.point.p).length();
        v = *hit;
        if (v.bsdf.traits().near_lambertian) return Candidate{v, -w, pixel * length, scatterings};
        const auto next = continue_walk(v, -w, From::eye, source);
        if (!next || !is_specular(next->event)) break;
        w = next->w;
    }
    return std::nullopt;
}

IrradianceRecord compute_record(const GatherRays& rays, const Candidate& c, const CacheOptions& options,
                                std::uint64_t index) {
    Rng rng(options.seed, StreamPurpose::cache, index);
    const HemisphereGrid grid(options.rays);
    const Frame frame(cache_normal(c.vertex, c.back));
    const Vec3 outside = facing(c.vertex.point.ng, c.back);
    const auto min_radius = static_cast<float>(options.min_radius * c.pixel);
    std::vector<HemisphereRay> found(static_cast<std::size_t>(grid.size()));
    for (int i = 0; i < grid.size(); ++i) {
        const double u0 = rng.next(), u1 = rng.next();
        const Vec3 local = grid.direction(i, u0, u1), w = frame.to_world(local);
        HemisphereRay& ray = found[static_cast<std::size_t>(i)];
        ray.distance = std::numeric_limits<float>::infinity();
        if (!(w.dot(outside) > 0)) continue; // a shading normal may look into the surface
        const auto arrival = rays.trace(c.vertex, w, local.z * kInvPi, c.scatterings, rng);
        // What lies nearer than the least reach can't be told apart anyway.
        ray = {arrival.indirect, std::max(arrival.distance, min_radius)};
    }
    return {c.vertex.point.p, frame.n, grid.estimate(found, frame), min_radius,
            static_cast<float>(options.max_radius * c.pixel)};
}

/// Pixels of one level in an order that jumps about, so that those of one batch are far from each other.
std::vector<int> level_pixels(const ImageWindow& window, int step) {
    std::vector<int> pixels;
    for (int y = step / 2; y < window.height; y += step)
        for (int x = step / 2; x < window.width; x += step) pixels.push_back(y * window.width + x);
    // A stride near the golden section of their number, without a common divisor.
    const std::size_t n = pixels.size();
    auto stride = static_cast<std::size_t>(0.618 * static_cast<double>(n)) | 1;
    while (n > 1 && std::gcd(stride, n) != 1) stride += 2;
    std::vector<int> order(n);
    for (std::size_t i = 0; i < n; ++i) order[i] = pixels[i * stride % n];
    return order;
}

/// Fills one level; batch by batch, since what a batch inserts tells the next what is still missing.
class LevelFill {
  public:
    LevelFill(const GatherRays& rays, const CacheOptions& options, IrradianceCache& cache)
        : rays_(rays), options_(options), cache_(cache) {}

    void run(int step, std::uint64_t level, const RunContext& context) {
        const ImageWindow& window = rays_.scene().camera().window();
        const auto pixels = static_cast<std::uint64_t>(window.width) * static_cast<std::uint64_t>(window.height);
        for (const int pixel : level_pixels(window, step)) {
            if (context.stopped()) return;
            Rng rng(options_.seed, StreamPurpose::cache, (2 * level + 1) * pixels + static_cast<std::uint64_t>(pixel));
            const Vec2 at(static_cast<float>(pixel % window.width + rng.next()),
                          static_cast<float>(pixel / window.width + rng.next()));
            const auto c = visible_point(rays_, window.to_window(at), rng);
            if (!c || is_covered(*c)) continue;
            batch_.push_back(*c);
            indices_.push_back(2 * level * pixels + static_cast<std::uint64_t>(pixel));
            if (batch_.size() == kBatch) flush();
        }
        flush();
    }

  private:
    bool is_covered(const Candidate& c) const {
        return cache_.irradiance(c.vertex.point.p, cache_normal(c.vertex, c.back)).weight >= kCovered;
    }
    void flush() {
        std::vector<IrradianceRecord> records(batch_.size());
        parallel_for(static_cast<std::int64_t>(batch_.size()), [&](std::int64_t i) {
            const auto k = static_cast<std::size_t>(i);
            records[k] = compute_record(rays_, batch_[k], options_, indices_[k]);
        });
        for (const IrradianceRecord& r : records) cache_.insert(r);
        batch_.clear();
        indices_.clear();
    }

    const GatherRays& rays_;
    const CacheOptions& options_;
    IrradianceCache& cache_;
    std::vector<Candidate> batch_;
    std::vector<std::uint64_t> indices_;
};

} // namespace

CacheOptions cache_options(const Settings& settings, std::uint64_t seed) {
    return {.error = settings.cache_error, .rays = static_cast<int>(settings.cache_rays), .seed = seed};
}

Vec3 cache_normal(const Vertex& v, const Vec3& back) {
    const Vec3 n = v.bsdf.shading_normal();
    // By the geometric side: a shading normal may turn away from the eye at a silhouette.
    return n.dot(facing(v.point.ng, back)) < 0 ? -n : n;
}

IrradianceCache fill_cache(const GatherRays& rays, const CacheOptions& options, const RunContext& context) {
    IrradianceCache cache(static_cast<float>(options.error));
    context.begin("irradiance cache", 6, "levels");
    LevelFill fill(rays, options, cache);
    std::uint64_t level = 0;
    for (const int step : {kCoarsest, kCoarsest / 2, kCoarsest / 4, kCoarsest / 8, 1, 1}) {
        fill.run(step, level++, context);
        context.advance(1);
    }
    context.end();
    return cache;
}

} // namespace keyhole
