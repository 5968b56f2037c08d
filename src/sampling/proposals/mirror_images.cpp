#include "sampling/proposals/mirror_images.h"

#include "core/rng.h"
#include "sampling/paths/walk.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace keyhole {
namespace {

constexpr int kRays = 1024;
constexpr int kFewest = 4; // rays that take a way: those of a curved mirror meet as many planes as there are rays
constexpr std::size_t kMostWays = 64;
constexpr double kLeastCosine = 1 - 1e-6; // between normals of one plane, as exact as floats have them
constexpr double kThickness = 1e-5;       // of a plane, over its distance from the origin and a point's rounding

/// The plane at a vertex, where it reflects as a flat mirror.
std::optional<FlatMirror> mirror_at(const Vertex& v, const Vec3& back) {
    if (v.point.site != Site::surface || !v.bsdf.delta(back, Event::reflect)) return std::nullopt;
    const Imath::V3d normal = Imath::V3d(v.point.ng).normalized();
    if (!(std::abs(normal.dot(Imath::V3d(v.bsdf.shading_normal()))) > kLeastCosine)) return std::nullopt;
    return FlatMirror{v.point.shape, normal, normal.dot(Imath::V3d(v.point.p))};
}

/// How many rays take a way, and what comes back along them [1, summed].
struct Traffic {
    int rays = 0;
    double reflected = 0;
};

/// All ways that rays from the eye take, and the mirrors on them.
class Survey {
  public:
    std::vector<FlatMirror> mirrors;
    std::map<MirrorImages::Way, Traffic> ways;

    void follow(const Scene& scene, Rng& rng) {
        const Vertex eye = sample_eye(scene, rng);
        const auto [u, v] = rng.next_point();
        Vec3 w = scene.camera().ray_direction(eye.point, Vec2(static_cast<float>(u), static_cast<float>(v)));
        MirrorImages::Way way;
        way.fill(MirrorImages::kNone);
        double reflected = 1;
        SurfacePoint origin = eye.point;
        for (int& mirror : way) {
            const auto hit = next_vertex(scene, origin, w);
            const auto plane = hit ? mirror_at(*hit, -w) : std::nullopt;
            if (!plane) return;
            const auto lobe = hit->bsdf.delta(-w, Event::reflect);
            mirror = index_of(*plane, hit->point);
            reflected *= luminance(lobe->coefficient);
            Traffic& traffic = ways[way];
            ++traffic.rays;
            traffic.reflected += reflected;
            origin = hit->point;
            w = lobe->to;
        }
    }

  private:
    int index_of(const FlatMirror& plane, const SurfacePoint& point) {
        const auto at = std::ranges::find_if(mirrors, [&](const FlatMirror& m) { return m.contains(point); });
        if (at != mirrors.end()) return static_cast<int>(at - mirrors.begin());
        mirrors.push_back(plane);
        return static_cast<int>(mirrors.size()) - 1;
    }
};

} // namespace

bool FlatMirror::contains(const SurfacePoint& point) const {
    if (point.shape != shape || !(std::abs(normal.dot(Imath::V3d(point.ng))) > kLeastCosine)) return false;
    const double distance = std::abs(normal.dot(Imath::V3d(point.p)) - offset);
    return distance <= kThickness * std::abs(offset) + 4 * static_cast<double>(point.offset);
}

MirrorImages::MirrorImages(const Scene& scene) {
    Survey survey;
    for (std::uint64_t i = 0; i < kRays; ++i) {
        Rng rng(0, StreamPurpose::mirror_images, i);
        survey.follow(scene, rng);
    }
    for (const auto& [way, traffic] : survey.ways)
        if (traffic.rays >= kFewest && traffic.reflected > 0) ways_.push_back({way, traffic.reflected});
    std::ranges::stable_sort(ways_, std::greater(), &WeightedWay::probability);
    if (ways_.size() > kMostWays) ways_.resize(kMostWays);
    double sum = 0;
    for (const WeightedWay& w : ways_) sum += w.probability;
    for (WeightedWay& w : ways_) w.probability /= sum;

    // Those that some way takes, by their new indices.
    std::vector<int> kept(survey.mirrors.size(), kNone);
    for (WeightedWay& w : ways_)
        for (int& mirror : w.way) {
            if (mirror == kNone) break;
            int& index = kept[static_cast<std::size_t>(mirror)];
            if (index == kNone) {
                index = static_cast<int>(mirrors_.size());
                mirrors_.push_back(survey.mirrors[static_cast<std::size_t>(mirror)]);
            }
            mirror = index;
        }
}

const MirrorImages::Way& MirrorImages::choose(double u) const {
    for (const WeightedWay& w : ways_)
        if ((u -= w.probability) < 0) return w.way;
    return ways_.front().way;
}

double MirrorImages::probability(const Way& way) const {
    const auto at = std::ranges::find(ways_, way, &WeightedWay::way);
    return at != ways_.end() ? at->probability : 0;
}

int MirrorImages::find(const SurfacePoint& point) const {
    const auto at = std::ranges::find_if(mirrors_, [&](const FlatMirror& m) { return m.contains(point); });
    return at != mirrors_.end() ? static_cast<int>(at - mirrors_.begin()) : kNone;
}

Imath::V3d MirrorImages::image(const Way& way, const Imath::V3d& p) const {
    Imath::V3d image = p;
    for (std::size_t i = way.size(); i-- > 0;)
        if (way[i] != kNone) image = mirrors_[static_cast<std::size_t>(way[i])].reflect(image);
    return image;
}

} // namespace keyhole
