// The random walk: the one loop that traces from vertex to vertex, from the eye or from the light. What is done at each
// vertex, when a walk ends, and by which roulette, is up to hooks.
#pragma once

#include "sampling/paths/roulette.h"
#include "sampling/paths/walk.h"

#include <new>
#include <utility>

namespace keyhole {

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
