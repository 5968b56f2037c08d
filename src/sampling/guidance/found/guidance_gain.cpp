#include "sampling/guidance/found/guidance_gain.h"

#include "core/shared_work.h"
#include "sampling/guidance/guided_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace keyhole {
namespace {

constexpr std::int64_t kLightPaths = 2048, kPathsOfPart = 64;
/// Half of the paths are free. What comes to pass in fewer than one of them, such as light beside an opening that is
/// drawn too small, isn't among them, and could be all that a larger gain would be measured against.
constexpr double kMostGain = kLightPaths / 2.0;
constexpr int kMostScatterings = 12;
/// Cells along the diagonal of the scene.
constexpr float kCells = 24;

/// Cells of place and of the main direction of the normal.
class Cells {
  public:
    using Cell = std::array<int, 4>;

    explicit Cells(const Scene& scene)
        : lower_(scene.lower()), size_((scene.upper() - scene.lower()).length() / kCells) {}

    Cell operator()(const Vec3& p, const Vec3& n) const {
        const Vec3 at = (p - lower_) / size_;
        const auto facet = static_cast<int>(facet_of(n));
        return {static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z), 2 * (facet % 3) + facet / 3};
    }

  private:
    Vec3 lower_;
    float size_;
};

/// Second moments of the power that arrives in a cell.
struct Moments {
    double led = 0, free = 0;

    void operator+=(const Moments& o) {
        led += o.led;
        free += o.free;
    }
};
using MomentsByCell = std::map<Cells::Cell, Moments>;

/// Adds up moments over the arrivals of paths.
struct MomentSink {
    const Cells& cells;
    MomentsByCell& moments;
    const LearnedEmission* learned;
    SurfacePoint x0{};     // where the path under way began
    bool has_left = false; // and whether it is known where to
    double ratio = 1;      // density with which free paths begin so, over that of those by power

    void sets_out(const SurfacePoint& from, bool /*guided*/) {
        x0 = from;
        has_left = false;
        ratio = 1;
    }
    void passes(const Vertex& v) {
        if (learned != nullptr && !std::exchange(has_left, true))
            ratio = learned->density_ratio(x0, direction(x0, v.point), v.point.p);
    }
    bool arrival(const Vertex& v, const Vec3& to_light, const Rgb& carried, const LightPast& past) {
        passes(v);
        if (!v.bsdf.traits().finite) return true;
        const double power = luminance(carried), square = power * power;
        moments[cells(v.point.p, facing(v.point.ng, to_light))] += {square, square * past.density / ratio};
        return true;
    }
};

} // namespace

double gain_by_guides(const Scene& scene, const LightGuides& guides, const std::vector<TransportEnd>& eye,
                      std::uint64_t seed, const RunContext& context, const LearnedEmission* learned) {
    const Cells cells(scene);
    const auto trace = [&](Range part) {
        MomentsByCell moments;
        MomentSink sink{cells, moments, learned};
        for (std::int64_t i = part.begin; i < part.end; ++i) {
            Rng rng(seed, StreamPurpose::guidance_gain, static_cast<std::uint64_t>(i));
            trace_guided_light_path(scene, {&guides, learned}, kMostScatterings, rng, sink);
        }
        return moments;
    };
    MomentsByCell all;
    for (const MomentsByCell& part : make_blocks({0, kLightPaths}, kPathsOfPart, context, trace))
        for (const auto& [cell, moments] : part) all[cell] += moments;
    std::map<Cells::Cell, double> importance;
    for (const TransportEnd& end : eye) importance[cells(end.point.p, end.n)] += end.weight;
    double sum = 0, weights = 0;
    for (const auto& [cell, weight] : importance) {
        const auto found = all.find(cell);
        if (found == all.end() || !(found->second.led > 0)) continue;
        sum += weight * std::log(found->second.free / found->second.led);
        weights += weight;
    }
    return weights > 0 && std::isfinite(sum) ? std::min(std::exp(sum / weights), kMostGain) : 1;
}

} // namespace keyhole
