#include "sampling/guidance/found/transport_ends.h"

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

} // namespace keyhole
