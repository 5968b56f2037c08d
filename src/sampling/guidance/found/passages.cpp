#include "sampling/guidance/found/passages.h"

#include "core/parallel.h"
#include "core/shared_work.h"
#include "sampling/paths/image_lattice.h"
#include "sampling/paths/random_walk.h"
#include "scene/warp.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace keyhole {
namespace {

/// Vertices of a path, at most: what comes after is a small part of the light.
constexpr int kMostVertices = 8;
constexpr std::int64_t kPathsOfBlock = 64; // paths

/// The hooks of walks that leave an end at every place of theirs that scatters finitely.
struct LeaveEnds : WalkHooks {
    std::vector<TransportEnd>& ends;
    const SurfacePoint* x0;
    double reference; ///< luminance that roulette keeps
    LastTwoVertices vertices{};

    Vertex& place() { return vertices.place(); }
    bool arrive(const Vertex& v, const WalkRay& ray) {
        if (v.point.site != Site::surface) return false;
        const double weight = luminance(ray.throughput);
        if (v.bsdf.traits().finite && weight > 0)
            ends.push_back({v.point, facing(v.point.ng, -ray.w), weight, x0 != nullptr ? *x0 : SurfacePoint{}, false});
        return true;
    }
    bool survives(Rgb& throughput, SampleSource& source) const {
        return play_roulette(photon_survival(throughput, reference), throughput, source);
    }
};

void trace_from_light(const Scene& scene, Rng& rng, std::vector<TransportEnd>& ends) {
    const auto light = emit_light(scene, rng);
    if (!light || is_black(light->power) || light->x0.site == Site::infinite) return;
    const double power = luminance(light->power);
    if (light->x0.site == Site::surface)
        ends.push_back({light->x0, facing(light->x0.ng, light->ray.w), power, light->x0, true});
    LeaveEnds walk{{}, ends, &light->x0, power};
    random_walk(scene, From::light, {&light->ray.origin, &light->x0, light->ray.w, light->power}, kMostVertices, rng,
                walk);
}

void trace_from_eye(const Scene& scene, const Vec2& image, Rng& rng, std::vector<TransportEnd>& ends) {
    const Vertex eye = sample_eye(scene, rng);
    LeaveEnds walk{{}, ends, nullptr, 1.0};
    random_walk(scene, From::eye, eye_ray(scene, eye.point, image), kMostVertices, rng, walk);
}

/// Half-angle of the cone about a line in which its neighbours lie [rad], how many of them are traced, and how many may
/// pass: beside any edge half of them do.
constexpr double kCone = 0.15;
constexpr int kNeighbours = 32, kMostPassed = 9;
/// A neighbour passes that comes so far, as a share of the line.
constexpr float kPasses = 0.9f;
constexpr std::int64_t kPairsOfBlock = 256, kRound = 16384, kPairsOfTrial = 1024; // pairs
/// Share of the pairs that have to see each other by no passage for light to need none.
constexpr double kOpen = 0.1;

/// Chooses ends in proportion to their weights.
class EndChoice {
  public:
    explicit EndChoice(std::span<const TransportEnd> ends) : ends_(ends) {
        double sum = 0;
        for (const TransportEnd& end : ends) up_to_.push_back(sum += end.weight);
    }
    const TransportEnd& operator()(SampleSource& source) const {
        const double u = source.next() * up_to_.back();
        const auto found = std::ranges::upper_bound(up_to_, u);
        return ends_[std::min(ends_.size() - 1, static_cast<std::size_t>(found - up_to_.begin()))];
    }

  private:
    std::span<const TransportEnd> ends_;
    std::vector<double> up_to_;
};

/// The passage from a to b, which see each other; none where their surroundings do so as well.
std::optional<Passage> passage(const Scene& scene, const TransportEnd& a, const TransportEnd& b, const Vec3& w,
                               SampleSource& source) {
    const float length = (b.point.p - a.point.p).length();
    const Frame frame(w);
    Passage found{a, b, {}};
    int passed = 0;
    for (int i = 0; i < kNeighbours; ++i) {
        const double u0 = source.next(), radius = kCone * std::sqrt(u0), angle = 2 * kPi * source.next();
        const Vec3 beside = frame.to_world(
            Vec3(static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle)), 1));
        const auto hit = scene.trace(a.point, beside.normalized());
        if (hit && hit->site == Site::surface && (hit->p - a.point.p).length() < kPasses * length)
            found.blockers.push_back({hit->p, hit->ng});
        else if (++passed > kMostPassed)
            return std::nullopt;
    }
    return found;
}

/// What a block of pairs came to.
struct Tried {
    std::vector<Passage> passages;
    std::int64_t facing = 0, open = 0; // pairs that could see each other, and those that do by no passage
};

Tried try_pairs(const Scene& scene, const EndChoice& light, const EndChoice& eye, Range pairs, std::uint64_t seed) {
    Tried tried;
    for (std::int64_t i = pairs.begin; i < pairs.end; ++i) {
        Rng rng(seed, StreamPurpose::passages, static_cast<std::uint64_t>(i));
        const TransportEnd &a = light(rng), &b = eye(rng);
        const Vec3 w = direction(a.point, b.point);
        if (!(a.n.dot(w) > 0 && b.n.dot(w) < 0)) continue;
        ++tried.facing;
        if (!scene.visible(a.point, b.point, w)) continue;
        if (auto found = passage(scene, a, b, w, rng))
            tried.passages.push_back(std::move(*found));
        else
            ++tried.open;
    }
    return tried;
}

} // namespace

TransportEnds trace_transport_ends(const Scene& scene, std::int64_t paths, std::uint64_t seed,
                                   const RunContext& context) {
    const auto trace = [&](Range block) {
        TransportEnds ends;
        for (std::int64_t i = block.begin; i < block.end; ++i) {
            Rng rng(seed, StreamPurpose::openings, static_cast<std::uint64_t>(i));
            trace_from_light(scene, rng, ends.light);
            trace_from_eye(scene, lattice_image_point(seed, StreamPurpose::openings, i), rng, ends.eye);
        }
        return ends;
    };
    TransportEnds all;
    for (const TransportEnds& ends : make_blocks({0, paths}, kPathsOfBlock, context, trace)) {
        all.light.insert(all.light.end(), ends.light.begin(), ends.light.end());
        all.eye.insert(all.eye.end(), ends.eye.begin(), ends.eye.end());
    }
    return all;
}

bool light_finds_its_way(const Scene& scene, const TransportEnds& ends, std::uint64_t seed, const RunContext& context) {
    if (ends.light.empty() || ends.eye.empty()) return true;
    check_stop(context);
    const Tried tried = try_pairs(scene, EndChoice(ends.light), EndChoice(ends.eye), {0, kPairsOfTrial}, seed);
    return static_cast<double>(tried.open) >= kOpen * static_cast<double>(tried.facing);
}

std::vector<Passage> find_passages(const Scene& scene, const TransportEnds& ends, const PassageSearch& search,
                                   const RunContext& context) {
    std::vector<Passage> found;
    if (ends.light.empty() || ends.eye.empty()) return found;
    const EndChoice light(ends.light), eye(ends.eye);
    const double until = context.seconds_left() - search.seconds;
    for (std::int64_t begin = 0; begin < search.pairs && found.size() < search.enough;) {
        const std::int64_t end = std::min(search.pairs, begin + kRound);
        const auto try_block = [&](Range pairs) { return try_pairs(scene, light, eye, pairs, search.seed); };
        for (Tried& block : make_blocks({begin, end}, kPairsOfBlock, context, try_block))
            std::ranges::move(block.passages, std::back_inserter(found));
        if (std::isfinite(until) && context.seconds_left() < until) break;
        begin = end;
    }
    return found;
}

} // namespace keyhole
