#include "methods/photons/find_coverage.h"

#include "core/shared_work.h"
#include "core/statistics.h"
#include "gather/spots/bright_balls.h"
#include "methods/method.h"
#include "sampling/paths/image_lattice.h"
#include "sampling/paths/path_tracer.h"

#include <algorithm>
#include <span>
#include <vector>

namespace keyhole {
namespace {

/// Light outside gather coverage is of no account below these shares: of what arrives from the emitters, and of the
/// indirect light that is seen.
constexpr double kLeastLight = 0.01, kLeastSeen = 0.1;
/// Variance of what a single gather ray finds outside gather coverage, relative to the square of all indirect light and
/// where rays are aimed at what is small and bright. Above this, thousands of rays still leave more noise than a
/// density estimate from photons would.
constexpr double kBearable = 200;

constexpr std::uint64_t kSeed = 1; // as GatherCoverage: the choice doesn't change with the seed
/// Gather rays to find out by. Fewer miss what few of them find, and take it for little.
constexpr std::int64_t kRays = 1 << 15, kBlock = 256;
/// So many, or twice as many, and so on, are enough where they leave no doubt: where as many as that find light outside
/// gather coverage, by their effective number, and its variance is half of what is bearable.
constexpr std::int64_t kFirst = 1 << 12;
constexpr double kSure = 40, kSurelyBearable = kBearable / 2;
/// What so many of them find may be chance. Where many others, by their effective number, find light as well, these
/// tell of the noise.
constexpr std::int64_t kChance = 3;
constexpr double kMany = 20;

/// What a gather ray finds.
struct GatheredLight {
    using LooksThroughGlass = std::true_type;
    const PathSet* set = nullptr;
    double near = 0, beyond = 0;
    Vec3 place{0, 0, 0}; ///< that it met
    float distance = 0;  ///< to there [m]; 0: it brought nothing

    static bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }
    void contribution(EyeWalk& walk, const Vertex& x0, const Rgb& value, LightClass light) {
        if (light != LightClass::second && light != LightClass::indirect) return;
        (is_d2_covered(*set, walk, x0) ? near : beyond) += luminance(value);
        place = walk[walk.d1 + 1].point.p;
        distance = (place - walk[walk.d1].point.p).length();
    }
};

/// A lampshade is met by few rays as well, but records look at it with rays of their own (HotSpots).
bool too_noisy(std::span<const GatheredLight> rays) {
    RunningStats all, beyond;
    for (const GatheredLight& ray : rays) {
        all.add(ray.near + ray.beyond);
        beyond.add(ray.beyond);
    }
    const double bearable = kBearable * all.mean() * all.mean();
    if (!(beyond.mean() > kLeastSeen * all.mean() && beyond.variance() > bearable)) return false;
    std::vector<RadianceSample> samples;
    for (const GatheredLight& ray : rays) samples.push_back({ray.place, ray.distance, ray.beyond});
    return beyond.variance() * find_bright_balls(samples).left > bearable;
}

/// How many rays that all found as much would be as good a sample of the light outside gather coverage.
double effective_rays(std::span<const GatheredLight> rays) {
    double sum = 0, squares = 0;
    for (const GatheredLight& ray : rays) {
        sum += ray.beyond;
        squares += ray.beyond * ray.beyond;
    }
    return squares > 0 ? sum * sum / squares : 0;
}

bool surely_bearable(std::span<const GatheredLight> rays) {
    RunningStats all, beyond;
    for (const GatheredLight& ray : rays) {
        all.add(ray.near + ray.beyond);
        beyond.add(ray.beyond);
    }
    return effective_rays(rays) > kSure && beyond.variance() < kSurelyBearable * all.mean() * all.mean();
}

/// Whether a final gather would be too noisy, or find nothing at all, of the light outside gather coverage.
bool too_noisy(const Scene& scene, const GatherCoverage& coverage, int max_scatterings, const RunContext& context) {
    const PathSet set{.coverage = &coverage};
    std::vector<GatheredLight> rays(kRays, GatheredLight{&set});
    const auto trace = [&](Range range) {
        parallel_blocks(range.size(), kBlock, context, [&](std::int64_t k) {
            const std::int64_t i = range.begin + k;
            Rng rng(kSeed, StreamPurpose::coverage_trial, static_cast<std::uint64_t>(i));
            trace_path(scene, lattice_image_point(kSeed, StreamPurpose::coverage_trial, i), max_scatterings, rng,
                       rays[static_cast<std::size_t>(i)]);
        });
    };
    for (std::int64_t begin = 0, end = kFirst; begin < kRays; begin = end, end *= 2) {
        trace({begin, end});
        if (surely_bearable(std::span(rays).first(static_cast<std::size_t>(end)))) return false;
    }
    if (effective_rays(rays) == 0) return true;
    if (!too_noisy(rays)) return false;
    std::ranges::nth_element(rays, rays.end() - kChance, {}, &GatheredLight::beyond);
    const std::span most(rays.data(), rays.size() - kChance);
    return effective_rays(most) < kMany || too_noisy(most);
}

} // namespace

std::int64_t coverage_paths(const Settings& settings) {
    return std::clamp<std::int64_t>(settings.importons / 8, 1 << 12, 1 << 16);
}

CoverageFound find_coverage(const Scene& scene, const Settings& settings, const RunContext& context) {
    CoverageFound found;
    // Standard photon mapping knows nothing of where photons are worth having: few would be where light is seen.
    if (!settings.gather_coverage || settings.method->stores_everywhere()) return found;
    const auto depth = static_cast<int>(settings.max_depth);
    const std::int64_t paths = coverage_paths(settings);
    GatherCoverage coverage(scene, depth, paths, context);
    found.beyond = light_outside_coverage(scene, coverage, depth, paths / 8, context);
    const bool always = settings.plan == Plan::all;
    if (always || (found.beyond > kLeastLight && too_noisy(scene, coverage, depth, context)))
        found.coverage = std::move(coverage);
    return found;
}

} // namespace keyhole
