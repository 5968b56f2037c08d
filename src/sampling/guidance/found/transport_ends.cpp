#include "sampling/guidance/found/transport_ends.h"

#include "core/parallel.h"
#include "core/shared_work.h"
#include "sampling/paths/image_lattice.h"
#include "sampling/paths/random_walk.h"

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

void append(std::vector<TransportEnd>& to, const std::vector<TransportEnd>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

} // namespace

TransportEnds trace_transport_ends(const Scene& scene, std::int64_t paths, std::uint64_t seed,
                                   const RunContext& context) {
    const std::int64_t blocks = (paths + kPathsOfBlock - 1) / kPathsOfBlock;
    std::vector<TransportEnds> parts(static_cast<std::size_t>(blocks));
    parallel_for(blocks, context, [&](std::int64_t b) {
        TransportEnds& part = parts[static_cast<std::size_t>(b)];
        for (std::int64_t i = b * kPathsOfBlock; i < std::min(paths, (b + 1) * kPathsOfBlock); ++i) {
            Rng rng(seed, StreamPurpose::openings, static_cast<std::uint64_t>(i));
            trace_from_light(scene, rng, part.light);
            trace_from_eye(scene, lattice_image_point(seed, StreamPurpose::openings, i), rng, part.eye);
        }
    });
    TransportEnds all;
    for (const TransportEnds& part : parts) {
        append(all.light, part.light);
        append(all.eye, part.eye);
    }
    return all;
}

} // namespace keyhole
