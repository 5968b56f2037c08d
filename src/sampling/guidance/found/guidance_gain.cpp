#include "sampling/guidance/found/guidance_gain.h"

#include "core/shared_work.h"
#include "sampling/guidance/guided_light.h"

#include <array>
#include <cmath>
#include <map>

namespace keyhole {
namespace {

constexpr std::int64_t kLightPaths = 2048, kPathsOfPart = 64;
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
        const std::array<float, 3> size{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
        const int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
        return {static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z), 2 * axis + (n[axis] < 0)};
    }

  private:
    Vec3 lower_;
    float size_;
};

/// Moments of the power that arrives in a cell.
struct Moments {
    double first = 0, led = 0, free = 0; // led and free: second ones

    void operator+=(const Moments& o) {
        first += o.first;
        led += o.led;
        free += o.free;
    }
};
using MomentsByCell = std::map<Cells::Cell, Moments>;

/// Adds up moments over the arrivals of paths.
struct MomentSink {
    const Cells& cells;
    MomentsByCell& moments;

    bool arrival(const Vertex& v, const Vec3& to_light, const Rgb& carried, const LightPast& past) {
        if (!v.bsdf.traits().finite) return true;
        const double power = luminance(carried), square = power * power;
        moments[cells(v.point.p, facing(v.point.ng, to_light))] += {power, square, square * past.density};
        return true;
    }
};

} // namespace

double gain_by_guides(const Scene& scene, const LightGuides& guides, const std::vector<TransportEnd>& eye,
                      std::uint64_t seed, const RunContext& context) {
    const Cells cells(scene);
    std::vector<MomentsByCell> parts(kLightPaths / kPathsOfPart);
    parallel_for(static_cast<std::int64_t>(parts.size()), context, [&](std::int64_t part) {
        MomentSink sink{cells, parts[static_cast<std::size_t>(part)]};
        for (std::int64_t i = part * kPathsOfPart; i < (part + 1) * kPathsOfPart; ++i) {
            Rng rng(seed, StreamPurpose::guidance_gain, static_cast<std::uint64_t>(i));
            trace_guided_light_path(scene, guides, kMostScatterings, rng, sink);
        }
    });
    MomentsByCell all;
    for (const MomentsByCell& part : parts)
        for (const auto& [cell, moments] : part) all[cell] += moments;
    std::map<Cells::Cell, double> importance;
    for (const TransportEnd& end : eye) importance[cells(end.point.p, end.n)] += end.weight;
    double free = 0, led = 0;
    for (const auto& [cell, weight] : importance) {
        const auto found = all.find(cell);
        if (found == all.end()) continue;
        const Moments& m = found->second;
        free += weight * m.free / (m.first * m.first);
        led += weight * m.led / (m.first * m.first);
    }
    return led > 0 && std::isfinite(free) ? free / led : 1;
}

} // namespace keyhole
