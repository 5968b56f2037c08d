#include "gather/fill_cache.h"

#include "core/parallel.h"
#include "core/shared_work.h"
#include "gather/compute_record.h"
#include "gather/outlying_records.h"
#include "gather/ray_shares.h"
#include "photonmap/surface/sight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace keyhole {
namespace {

constexpr int kCoarsest = 16;       // [pixels] between the points of the first level
constexpr std::size_t kBatch = 64;  // records computed at once
constexpr std::size_t kAhead = 256; // pixels whose points are found at once
constexpr float kCovered = 0.1f;    // share below which a point needs a record of its own
constexpr float kLift = 0.1f;       // height at which places look at each other, over their distance
constexpr double kLeastWorth = 40;  // rays, fewer of which are no record
constexpr double kFirst = 0.5;      // share of rays that each record gets alike
constexpr int kLeastMore = 8;       // fewer rays are not worth a hemisphere
constexpr std::array kSteps{kCoarsest, kCoarsest / 2, kCoarsest / 4, kCoarsest / 8, 1, 1};

/// What hides `to` from a place of a surface with `normal`, a little above both.
std::optional<Wall> wall_between(const Scene& scene, const Vec3& from, const Vec3& normal, const Vec3& to) {
    const Vec3 d = to - from;
    SurfacePoint above;
    above.p = from + normal * std::max(kLift * d.length(), 2 * scene.rounding_along(normal, from));
    above.ng = normal;
    const auto hit = d == Vec3(0, 0, 0) ? std::nullopt : scene.trace(above, d.normalized());
    if (!hit || hit->site == Site::infinite || (hit->p - above.p).length2() > d.length2()) return std::nullopt;
    Vec3 n = hit->ng - normal * hit->ng.dot(normal); // along the surface
    if (!(n.length2() > 0)) return std::nullopt;
    n.normalize();
    if (n.dot(d) < 0) n = -n;
    return Wall{n, n.dot(hit->p - above.p)};
}

/// Pixels of one level in an order that jumps about, so that those of one batch are far from each other.
class LevelPixels {
  public:
    LevelPixels(const ImageWindow& window, int step)
        : width_(static_cast<std::uint64_t>(window.width)), step_(static_cast<std::uint64_t>(step)),
          across_(points(window.width)), size_(across_ * points(window.height)) {
        // Near the golden section of their number, without a common divisor.
        stride_ = static_cast<std::uint64_t>(0.618 * static_cast<double>(size_)) | 1;
        while (size_ > 1 && std::gcd(stride_, size_) != 1) stride_ += 2;
    }
    std::uint64_t size() const { return size_; }
    /// Its number in the window, row by row.
    std::uint64_t operator[](std::uint64_t i) const {
        const std::uint64_t k = i * stride_ % size_;
        return place(k / across_) * width_ + place(k % across_);
    }

  private:
    std::uint64_t points(int pixels) const {
        return (static_cast<std::uint64_t>(pixels) + step_ - 1 - step_ / 2) / step_;
    }
    std::uint64_t place(std::uint64_t point) const { return step_ / 2 + point * step_; }

    std::uint64_t width_, step_, across_, size_, stride_ = 1;
};

/// Fills level by level; batch by batch, since what a batch inserts tells the next what is still missing.
class CacheFill {
  public:
    CacheFill(const RecordMaker& maker, const CacheOptions& options, IrradianceCache& cache)
        : maker_(maker), rays_(maker.rays()), options_(options), cache_(cache),
          first_(std::max(kLeastMore, static_cast<int>(std::lround(kFirst * options.rays)))) {}

    void fill_level(int step, std::uint64_t level, const RunContext& context) {
        const LevelPixels pixels(rays_.scene().camera().window(), step);
        for (std::size_t begin = 0; begin < pixels.size() && !context.stopped(); begin += kAhead) {
            std::vector<Candidate> candidates(std::min(kAhead, pixels.size() - begin));
            parallel_for(static_cast<std::int64_t>(candidates.size()), [&](std::int64_t k) {
                const auto i = static_cast<std::size_t>(k);
                candidates[i] = candidate(pixels[begin + i], level);
            });
            const std::size_t known = cache_.size();
            for (const Candidate& c : candidates) {
                // Records that were put in meanwhile may cover it.
                if (!c.point || (cache_.size() > known && is_covered(*c.point))) continue;
                batch_.push_back(*c.point);
                indices_.push_back(c.index);
                if (batch_.size() == kBatch) flush(context);
            }
        }
        flush(context);
    }

    int first() const { return first_; }
    /// The rest of the rays, where records have the most to say: most of them stand in corners and serve a few pixels.
    void refine(int rays_on_average, const RunContext& context) {
        if (rays_on_average <= first_) return;
        std::vector<double> weights = cache_.relative_noise();
        for (std::size_t i = 0; i < weights.size(); ++i) weights[i] *= cache_.radius(i) / placed_[i].pixel;
        const std::vector<int> rays = share_rays(weights, first_, rays_on_average - first_);
        const std::uint64_t streams = 2 * kSteps.size() * pixels(); // that fill_level() uses
        for (std::size_t begin = 0; begin < placed_.size() && !context.stopped(); begin += kBatch) {
            std::vector<HemisphereEstimate> found(std::min(kBatch, placed_.size() - begin));
            const auto more = [&](std::size_t i) { return rays[begin + i] - first_; };
            shared_for(found, context, [&](std::int64_t k) {
                const auto i = static_cast<std::size_t>(k);
                if (more(i) >= kLeastMore) found[i] = maker_.light(placed_[begin + i], more(i), streams + begin + i);
            });
            for (std::size_t i = 0; i < found.size(); ++i)
                if (more(i) >= kLeastMore)
                    cache_.refine(begin + i, found[i], more(i) / static_cast<double>(rays[begin + i]));
        }
    }

  private:
    std::uint64_t pixels() const {
        const ImageWindow& window = rays_.scene().camera().window();
        return static_cast<std::uint64_t>(window.width) * static_cast<std::uint64_t>(window.height);
    }
    /// A point that needs a record, and the random stream of that; none where there are records enough.
    struct Candidate {
        std::optional<VisiblePoint> point;
        std::uint64_t index = 0;
    };
    Candidate candidate(std::uint64_t pixel, std::uint64_t level) const {
        const ImageWindow& window = rays_.scene().camera().window();
        const auto width = static_cast<std::uint64_t>(window.width), index = 2 * level * pixels() + pixel;
        Rng rng(options_.seed, StreamPurpose::cache, index + pixels());
        const std::uint64_t column = pixel % width, row = pixel / width;
        const double across = static_cast<double>(column) + rng.next(), down = static_cast<double>(row) + rng.next();
        const Vec2 at(static_cast<float>(across), static_cast<float>(down));
        auto c = visible_point(rays_, window.to_window(at), rng);
        if (c && is_covered(*c)) c.reset();
        return {c, index};
    }
    /// A record that a wall hides doesn't tell what light there is on this side of it, however far it is used. Once a
    /// record stands here, the two end where they contradict each other.
    bool is_covered(const VisiblePoint& c) const {
        const SurfaceRegion here{c.vertex.point.p, facing(c.vertex.point.ng, c.back)};
        const auto sees = [&](const Vec3& record) {
            const float apart = (record - here.position).length();
            return apart < c.pixel || in_sight(rays_.scene(), here, kLift * apart, record);
        };
        return cache_.covers(here.position, cache_normal(c.vertex, c.back), kCovered, sees);
    }
    void flush(const RunContext& context) {
        std::vector<IrradianceRecord> records(batch_.size());
        shared_for(records, context, [&](std::int64_t i) {
            const auto k = static_cast<std::size_t>(i);
            records[k] = maker_.compute(batch_[k], first_, indices_[k]);
        });
        const WallBetween wall = [this](const Vec3& from, const Vec3& normal, const Vec3& to) {
            return wall_between(rays_.scene(), from, normal, to);
        };
        for (const IrradianceRecord& r : records) cache_.insert(r, wall);
        placed_.insert(placed_.end(), batch_.begin(), batch_.end());
        batch_.clear();
        indices_.clear();
    }

    const RecordMaker& maker_;
    const GatherRays& rays_;
    const CacheOptions& options_;
    IrradianceCache& cache_;
    int first_;                        // rays of each record before refine()
    std::vector<VisiblePoint> placed_; // where the cache's records are
    std::vector<VisiblePoint> batch_;
    std::vector<std::uint64_t> indices_;
};

constexpr double kFewestRays = 64;       // that tell how far a record is good for
constexpr std::int64_t kMostToLook = 16; // rays of records that one ray that looks for hot spots has to help

/// Rays to look for hot spots by: not many where those that spots would help are few, as in the small pictures that
/// methods are chosen by, which have about a record a pixel.
std::int64_t spot_rays(const CacheOptions& options, const ImageWindow& window) {
    const auto worth = std::clamp<std::int64_t>(std::int64_t{256} * options.rays, 1 << 13, 1 << 16);
    const auto helped = static_cast<std::int64_t>(window.size() * options.rays);
    return std::min(worth, std::max(std::int64_t{1} << 11, helped / kMostToLook));
}

/// IrradianceCache::growth() by how many records there were after each level: the finest look at every pixel, the one
/// before at a few, as if the picture were smaller.
double growth(const std::array<double, kSteps.size()>& records) {
    constexpr std::size_t kFinest = kSteps.size() - 2;
    static_assert(kSteps[kFinest] == 1 && kSteps[kFinest - 1] > 1);
    const double finer = std::pow(kSteps[kFinest - 1], 2.0);
    if (!(records[kFinest - 1] > 0)) return 1;
    return std::clamp(std::log(records[kFinest] / records[kFinest - 1]) / std::log(finer), 0.0, 1.0);
}

/// A sum over o^2 times as many records has o^-2 times the variance, which falls with the number of rays as well, and a
/// square of the bias that grows as o^4: both are least together where o goes by the sixth root of the rays. With 1600
/// of them, twice.
double overlap(double rays) { return 2 * std::pow(rays / 1600.0, -1 / 6.0); }

/// By how much records may predict each other wrongly, over the cache's error: it falls as their noise does, for what
/// is wrong between them would be all that is left.
double doubt(double rays) { return std::min(1.0, std::sqrt(1000 / rays)) / 3; }

} // namespace

CacheOptions cache_options(const Settings& settings, double shrink, std::uint64_t seed) {
    const auto rays = static_cast<double>(settings.cache_rays);
    CacheOptions options;
    options.error = settings.cache_error * shrink;
    options.min_radius = settings.cache_min_reach * shrink;
    options.min_radius_by_light = std::max(options.min_radius, options.min_radius_by_light * shrink);
    options.max_radius = std::max(options.min_radius, options.max_radius * shrink);
    options.rays = static_cast<int>(std::max(rays * shrink * shrink, std::min(rays, kFewestRays)));
    // The rays of all passes count; their number grows as the sixth power of 1 / shrink.
    options.overlap = std::clamp(overlap(rays) * shrink, 1.0, 2.0);
    options.doubt = doubt(rays);
    options.seed = seed;
    return options;
}

HotSpots find_hot_spots(const GatherRays& rays, const CacheOptions& options, const RunContext& context) {
    return {rays, spot_rays(options, rays.scene().camera().window()), options.seed, context};
}

IrradianceCache fill_cache(const GatherRays& rays, const HotSpots& spots, const CacheOptions& options,
                           const RunContext& context, const RaysOfRecords& decide) {
    IrradianceCache cache(static_cast<float>(options.error), static_cast<float>(options.overlap),
                          static_cast<float>(options.doubt));
    const ProgressStage progress(context, "irradiance cache", kSteps.size() + 1, "levels");
    const RecordMaker maker(rays, spots, options);
    CacheFill fill(maker, options, cache);
    const double start = context.seconds_left();
    std::uint64_t level = 0;
    std::array<double, kSteps.size()> records{};
    for (const int step : kSteps) {
        // Where fewer rays would do, pixels are better off with gather rays of their own.
        if (step == kCoarsest || options.rays_for_pixel * step >= kLeastWorth) fill.fill_level(step, level, context);
        records[level++] = static_cast<double>(cache.size());
        context.advance(1);
    }
    const double seconds = std::isfinite(start) ? start - context.seconds_left() : 0;
    fill.refine(decide ? decide({cache, fill.first(), seconds}) : options.rays, context);
    share_outlying_light(cache);
    cache.set_growth(growth(records));
    context.advance(1);
    return cache;
}

} // namespace keyhole
