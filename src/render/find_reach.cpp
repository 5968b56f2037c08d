#include "render/find_reach.h"

#include "core/parallel.h"
#include "core/statistics.h"
#include "sampling/image_lattice.h"
#include "sampling/path_tracer.h"

#include <algorithm>
#include <vector>

namespace keyhole {
namespace {

/// Light beyond reach is of no account below these shares: of what arrives from the emitters, and of the indirect light
/// that is seen.
constexpr double kLeastLight = 0.01, kLeastSeen = 0.1;
/// Variance of what a single gather ray finds beyond reach, relative to the square of all indirect light. Above this,
/// thousands of rays still leave more noise than a density estimate from photons would.
constexpr double kBearable = 40;

constexpr std::int64_t kBlocks = 64;
constexpr std::uint64_t kSeed = 1; // as Reach: the choice doesn't change with the seed

/// What one gather ray after the other finds.
struct GatheredLight {
    const PathSet& set;
    double near = 0, beyond = 0; // of the ray
    RunningStats all{}, all_beyond{};

    static bool arrival(const EyeWalk& /*walk*/, const Rgb& /*throughput*/, int /*finite*/) { return true; }
    void contribution(const EyeWalk& walk, const Vertex& x0, const Rgb& value, LightClass light) {
        if (light == LightClass::second || light == LightClass::indirect)
            (reaches_d2(set, walk, x0) ? near : beyond) += luminance(value);
    }
    void end() {
        all.add(near + beyond);
        all_beyond.add(beyond);
        near = beyond = 0;
    }
};

/// Whether a final gather would be too noisy, or find nothing at all, of the light beyond reach.
bool too_noisy(const Scene& scene, const Reach& reach, int max_scatterings, std::int64_t paths) {
    const PathSet set{.reach = &reach};
    std::vector<GatheredLight> parts(kBlocks, GatheredLight{set});
    parallel_for(kBlocks, [&](std::int64_t b) {
        GatheredLight& part = parts[static_cast<std::size_t>(b)];
        const Range range = split(paths, kBlocks, b);
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            Rng rng(kSeed, StreamPurpose::reach_trial, static_cast<std::uint64_t>(i));
            trace_path(scene, lattice_image_point(kSeed, StreamPurpose::reach_trial, i), max_scatterings, rng, part);
            part.end();
        }
    });
    RunningStats all, beyond;
    for (const GatheredLight& part : parts) {
        all.merge(part.all);
        beyond.merge(part.all_beyond);
    }
    if (!(beyond.mean() > 0)) return true;
    return beyond.mean() > kLeastSeen * all.mean() && beyond.variance() > kBearable * all.mean() * all.mean();
}

} // namespace

std::int64_t reach_paths(const Settings& settings) {
    return std::clamp<std::int64_t>(settings.importons / 8, 1 << 12, 1 << 16);
}

ReachFound find_reach(const Scene& scene, const Settings& settings) {
    ReachFound found;
    // Standard photon mapping knows nothing of where photons are worth having: few would be where light is seen.
    if (settings.reach == "off" || settings.method == "pm") return found;
    const auto depth = static_cast<int>(settings.max_depth);
    const std::int64_t paths = reach_paths(settings);
    Reach reach(scene, depth, paths);
    found.beyond = light_beyond_reach(scene, reach, depth, paths / 8);
    const bool always = settings.plan == "all";
    if (always || (found.beyond > kLeastLight && too_noisy(scene, reach, depth, paths / 2)))
        found.reach = std::move(reach);
    return found;
}

} // namespace keyhole
