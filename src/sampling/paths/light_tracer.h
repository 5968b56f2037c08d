// Light tracing: power carried from the emitters.
#pragma once

#include "sampling/paths/clear_glass.h"
#include "sampling/paths/random_walk.h"

#include <optional>

namespace keyhole {

/// What light met before it arrived somewhere.
struct LightPast {
    struct Place {
        Vec3 p, n;                   ///< world space; geometric normal on the side where light arrived
        bool through;                ///< whether the surface sends light through
        int index;                   ///< of the vertex from the light's end, as in DiffuseVertices
        std::optional<bool> covered; ///< whether gather rays come to it, if that was asked
    };
    std::optional<Place> last;  ///< where it was last scattered by a vertex that isn't specular; none: nowhere
    bool specular = false;      ///< whether there was a specular one
    bool from_infinity = false; ///< whether its emitter lies there
    int scatterings = 0;        ///< how many vertices scattered it
    double density = 1;         ///< of the walks that may have led there, over that of a free one without roulette

    /// Whether only specular vertices scattered it, and at least one did.
    bool caustic() const { return specular && !last; }

    /// The first vertex that it comes straight to, where it arrives from `to_light` now: see light_class().
    int first_lit(const Vec3& to_light) const {
        if (last) return lit_;
        return straight_.straight(-to_light, from_infinity) ? scatterings + 1 : 1;
    }

    /// Light that comes from `to_light` goes on from `v` by its event.
    void meet(const Vertex& v, const Vec3& to_light) {
        if (!last && !v.specular()) lit_ = first_lit(to_light);
        ++scatterings;
        if (v.specular()) {
            specular = true;
            if (!last) straight_.meet(v, -to_light);
            return;
        }
        last = {v.point.p, facing(v.point.ng, to_light), v.bsdf.traits().through, scatterings, {}};
        const std::uint8_t side = KnownCoverage::side(v.point.ng, to_light);
        if ((v.coverage.asked & side) != 0) last->covered = (v.coverage.covered & side) != 0;
    }

  private:
    StraightLight straight_{}; // before `last`
    int lit_ = 1;              // where there is that
};

/// How light paths go on that know nothing of where they are wanted.
struct ScatterByBsdf {
    /// `reference`: luminance that roulette keeps a path's power near [W].
    static std::optional<Continuation> continue_walk(const Vertex& v, const Vec3& to_light, SampleSource& source,
                                                     double& /*reference*/) {
        return keyhole::continue_walk(v, to_light, From::light, source);
    }
};

/// The hooks of trace_light_path().
template <class Sink, class Scattering> struct LightTracing : WalkHooks {
    Sink& sink;
    const Scattering& scattering;
    double reference; // luminance that roulette keeps power near: what was emitted [W]
    LastTwoVertices vertices{};
    LightPast past{};

    Vertex& place() { return vertices.place(); }
    bool arrive(Vertex& v, const WalkRay& ray) {
        return v.point.site != Site::infinite && sink.arrival(v, -ray.w, ray.throughput, past);
    }
    std::optional<Continuation> go_on(const Vertex& v, const Vec3& back, From /*from*/, SampleSource& source) {
        return scattering.continue_walk(v, back, source, reference);
    }
    bool leave(const Vertex& v, const Continuation& /*next*/, const WalkRay& ray) {
        past.meet(v, -ray.w);
        return true;
    }
    bool survives(Rgb& power, SampleSource& source) const {
        return play_roulette(photon_survival(power, reference), power, source);
    }
};

/// Traces a light path that begins as `light` with at most `max_scatterings` vertices after the emitter.
///
/// Tells `sink`:
///   sink.arrival(vertex, to_light, power, past): light of RGB `power` [W] arrived at `vertex`, which lies on
///     a surface, from direction `to_light` (unit); `past`: a LightPast. False ends the path.
///   sink.sets_out(x0, guided), where it has that: light leaves emitter point x0; `guided`: along a user path.
/// The expected sum of power over the arrivals in a region is the flux that arrives there. `scattering` chooses where
/// light goes on.
template <class Sink, class Scattering = ScatterByBsdf>
void trace_light_path(const Scene& scene, const EmittedLight& light, int max_scatterings, SampleSource& source,
                      Sink& sink, const Scattering& scattering = {}) {
    if (is_black(light.power)) return;
    if constexpr (requires { sink.sets_out(light.x0, false); }) sink.sets_out(light.x0, false);
    LightTracing<Sink, Scattering> tracing{{}, sink, scattering, luminance(light.power)};
    tracing.past.from_infinity = light.x0.site == Site::infinite;
    random_walk(scene, From::light, {&light.ray.origin, &light.x0, light.ray.w, light.power}, max_scatterings, source,
                tracing);
}

/// The same from an emitter chosen by power.
template <class Sink> void trace_light_path(const Scene& scene, int max_scatterings, SampleSource& source, Sink& sink) {
    if (const auto light = emit_light(scene, source)) trace_light_path(scene, *light, max_scatterings, source, sink);
}

} // namespace keyhole
