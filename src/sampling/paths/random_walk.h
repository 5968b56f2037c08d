// The random walk: the one loop that traces from vertex to vertex, from the eye or from the light. What is done at each
// vertex, when a walk ends, and by which roulette, is up to hooks.
#pragma once

#include "core/rng.h"
#include "core/vec.h"
#include "sampling/paths/walk.h"

#include <algorithm>
#include <new>
#include <utility>

namespace keyhole {

// Russian roulette on walks (Arvo and Kirk 1990): every rule by which one is ended early. A walk that survives carries
// its throughput over the probability of that, so that no rule changes an expectation; what they trade is work for
// noise. The photon stores thin photons by their weights (map_stores.h), which is no matter of walks.

/// Walks from the eye, by the largest component of their throughput. It begins with the fifth scattering
/// (`scatterings`: those before): earlier ones matter most. At 0.95 no walk goes on for ever, at 0.05 none becomes an
/// outlier.
inline double eye_survival(const Rgb& throughput, int scatterings) {
    if (scatterings < 4) return 1;
    return std::clamp(std::max({throughput.x, throughput.y, throughput.z}), 0.05, 0.95);
}

/// Sub-paths that are to be joined, from either end, by the luminance of what is left of them since their start. Every
/// vertex costs connections, but one that is lost takes all of them with it: 0.1 at least. `vertices`: so far.
inline double subpath_survival(const Rgb& carried, std::size_t vertices) {
    if (vertices < 4) return 1;
    return std::clamp(luminance(carried), 0.1, 0.95);
}

/// Light that leaves photons: what survives keeps about `reference` [W], the luminance of what was emitted, so that
/// photons are alike (Jensen 2001, section 5.2); where directions were learned, that of what BSDFs would have made of
/// it.
inline double photon_survival(const Rgb& power, double reference) {
    return std::min(1.0, luminance(power) / reference);
}

/// Whether a walk survives what it does with probability `survival`; no number is drawn where that is certain. Its
/// throughput is divided by it.
inline bool play_roulette(double survival, Rgb& throughput, SampleSource& source) {
    if (!(survival < 1)) return true;
    if (source.next() >= survival) return false;
    throughput /= survival;
    return true;
}

/// What a walk does where it has nothing of its own to do. Hooks derive from this and hide what they need; besides,
/// they have
///   Vertex& place(): a new vertex, which the next one is made in. That before it must stay where it is.
///   bool arrive(Vertex& v, const WalkRay& ray): `ray` has met `v`; its throughput is what arrives there. False ends
///     the walk.
struct WalkHooks {
    /// The ray met nothing; the vertex that was last made isn't one.
    static void lost() {}
    /// Where the walk goes on from `v`, which it reached along `back`.
    static std::optional<Continuation> go_on(const Vertex& v, const Vec3& back, From from, SampleSource& source) {
        return continue_walk(v, back, from, source);
    }
    /// Nothing goes on from `v`.
    static void absorbed(const Vertex& /*v*/) {}
    /// The walk goes on from `v`, whose event is chosen; `ray` is still that which led there. False ends it.
    static bool leave(const Vertex& /*v*/, const Continuation& /*next*/, const WalkRay& /*ray*/) { return true; }
    /// The walk's roulette, as play_roulette(); `throughput` is what has left the last vertex.
    static bool survives(Rgb& /*throughput*/, SampleSource& /*source*/) { return true; }
};

/// Follows `ray` and traces on for at most `most` vertices. How light goes on from the last of them isn't asked for.
template <class Hooks>
void random_walk(const Scene& scene, From from, WalkRay ray, int most, SampleSource& source, Hooks& hooks) {
    for (int n = 1; n <= most; ++n) {
        Vertex& v = hooks.place();
        if (!follow(scene, ray, v, source)) return hooks.lost();
        ray.throughput *= ray.clear;
        if (!hooks.arrive(v, std::as_const(ray)) || n == most) return;
        const auto next = hooks.go_on(v, -ray.w, from, source);
        if (!next) return hooks.absorbed(v);
        v.event = next->event;
        if (!hooks.leave(v, *next, std::as_const(ray))) return;
        ray.throughput *= next->weight;
        if (!hooks.survives(ray.throughput, source)) return;
        ray.origin = ray.last = &v.point;
        ray.w = next->w;
    }
}

/// Room for the last two vertices of a walk that keeps no more.
class LastTwoVertices {
  public:
    LastTwoVertices() {} // NOLINT(modernize-use-equals-default): that would let initialisers clear the vertices first
    Vertex& place() {
        last_ ^= 1;
        return *::new (static_cast<void*>(vertices_ + last_)) Vertex;
    }

  private:
    Vertex vertices_[2];
    int last_ = 0;
};

/// Walks of which only specular events lead on, by the choices of the BSDFs.
struct SpecularWalkHooks : WalkHooks {
    static bool leave(const Vertex& /*v*/, const Continuation& next, const WalkRay& /*ray*/) {
        return is_specular(next.event);
    }
};

} // namespace keyhole
