// Light tracing that follows user paths: half of the light paths begin along one of them, the others by power or where
// that was learned, and every photon is weighed by both (the balance heuristic, Veach 1997, section 9.2.2). This is how
// photons get through a keyhole.
#pragma once

#include "sampling/guidance/guided_subpath.h"
#include "sampling/guidance/learned/learned_emission.h"
#include "sampling/paths/light_tracer.h"

namespace keyhole {

/// How light tracing makes light paths. What they point to must outlive this.
struct LightPathSampling {
    const LightGuides* user_paths = nullptr;  ///< that half of the light paths follow, where there are any
    const LearnedEmission* learned = nullptr; ///< where the others begin; null: by power

    bool guided() const { return user_paths != nullptr && !user_paths->empty(); }
    /// The first edge of a path that follows no user path. None where nothing emits.
    std::optional<EmittedLight> emit(const Scene& scene, SampleSource& source) const {
        return learned != nullptr ? learned->sample(source) : emit_light(scene, source);
    }
};

/// A light path on its way, with what a mixture of guided and free walks makes of its power.
class GuidedLightWalk {
  public:
    /// Share of the light paths that begin along a user path.
    static constexpr double kGuided = 0.5;

    GuidedLightWalk(const Scene& scene, const LightPathSampling& sampling);

    /// Leaves emitter point x0 along `w` (unit). False where it sends no light there.
    bool emit(const SurfacePoint& x0, const Vec3& w);
    /// Light arrives at `v` on its way.
    void arrive(const Vertex& v);
    /// Goes on as continue_walk() chose. Returns the probability with which a free walk has to survive this: roulette
    /// keeps its power near that which was emitted, or came along a user path. 0 where no light goes there.
    double leave(const Continuation& next) { return leave(next.event, next.weight, next.forward); }
    /// The same for light that is scattered by `event` into `w` (unit).
    double leave(Event event, const Vec3& w);

    /// What it has met so far, of which the emitter's point is the first.
    const Path& path() const { return *path_; }
    Vertex& last() { return path_->x.back(); }
    const Vertex& last() const { return path_->x.back(); }
    int vertices() const { return path_->vertices(); }
    /// Unit direction back to the vertex before the last.
    Vec3 to_light() const { return direction(last().point, path_->x[path_->x.size() - 2].point); }
    const LightPast& past() const { return past_; }
    /// Carried by one of the walks of the mixture [W].
    Rgb power() const { return power_ / density_; }
    /// Whether a user path could have led here.
    bool guided() const { return guided_; }

  private:
    double leave(Event event, const Rgb& weight, double pdf);

    const Scene* scene_;
    LightPathSampling sampling_;
    Path* path_;           ///< its events and pdf_from_light only
    Rgb power_{0.0};       ///< contribution over density of a free walk by power without roulette
    double product_ = 1;   ///< density of the vertices so far, of such a walk
    double density_;       ///< of the mixture, over that. What the free walks of it survive is part of it:
                           ///< else those that come where guided ones do would bring their emitted power
    double reference_ = 0; ///< luminance of power() that roulette keeps [W]
    double next_pdf_ = 0;
    bool guided_ = false;
    LightPast past_;
};

/// As trace_light_path(), which it equals in expectation. There must be a user path. What a guided walk meets before
/// its user path ends is left to the free ones; `past` tells the sink of it, and sink.passes(vertex), where it has
/// that.
template <class Sink>
void trace_guided_light_path(const Scene& scene, const LightPathSampling& sampling, int max_scatterings, Rng& rng,
                             Sink& sink) {
    GuidedLightWalk walk(scene, sampling);
    const bool along_user_path = rng.next() < GuidedLightWalk::kGuided;
    if (along_user_path) {
        SubPath light;
        Failure why{};
        if (!sampling.user_paths->choose(rng).trace(light, rng, why)) return;
        for (std::size_t i = 0; i + 1 < light.size(); ++i) {
            const Vec3 along = direction(light[i].point, light[i + 1].point);
            if (!(i == 0 ? walk.emit(light[0].point, along) : walk.leave(light[i].event, along) > 0)) return;
            walk.arrive(light[i + 1]);
        }
        if (!walk.guided() || static_cast<int>(light.size()) > max_scatterings + 1) return;
    } else {
        const auto light = sampling.emit(scene, rng);
        if (!light || !walk.emit(light->x0, light->ray.w)) return;
        const auto hit = next_vertex(scene, light->ray.origin, light->ray.w);
        if (!hit || hit->point.site == Site::infinite) return;
        walk.arrive(*hit);
    }
    if constexpr (requires { sink.sets_out(walk.path().x[0].point, along_user_path); }) {
        sink.sets_out(walk.path().x[0].point, along_user_path);
        for (int i = 1; i + 1 < walk.vertices(); ++i) sink.passes(walk.path().x[i]);
    }
    while (sink.arrival(walk.last(), walk.to_light(), walk.power(), walk.past()) &&
           walk.vertices() <= max_scatterings) {
        const auto next = continue_walk(walk.last(), walk.to_light(), From::light, rng);
        if (!next) return;
        const double survive = walk.leave(*next);
        if (survive < 1 && rng.next() >= survive) return;
        const auto hit = next_vertex(scene, walk.last(), next->w);
        if (!hit || hit->point.site == Site::infinite) return;
        walk.arrive(*hit);
    }
}

/// Along user paths where there are some.
template <class Sink>
void trace_light_path(const Scene& scene, const LightPathSampling& sampling, int max_scatterings, Rng& rng,
                      Sink& sink) {
    if (sampling.guided()) {
        trace_guided_light_path(scene, sampling, max_scatterings, rng, sink);
    } else if (const auto light = sampling.emit(scene, rng)) {
        trace_light_path(scene, *light, max_scatterings, rng, sink);
    }
}

} // namespace keyhole
