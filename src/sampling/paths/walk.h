// Sub-paths traced from either end.
#pragma once

#include "core/rng.h"
#include "sampling/paths/path.h"
#include "scene/scene.h"

#include <optional>

namespace keyhole {

/// A vertex at `point` with its BSDF looked up.
Vertex make_vertex(const SurfacePoint& point);

/// x0 on an emitter chosen by power, with its density (choice times point). None if nothing emits.
struct EmitterVertex {
    Vertex vertex;
    double pdf;
};
std::optional<EmitterVertex> sample_emitter(const Scene& scene, SampleSource& source);
/// Makes the new vertex `v` x0, and returns its density; 0 if nothing emits.
double sample_emitter(const Scene& scene, SampleSource& source, Vertex& v);

/// The eye vertex.
Vertex sample_eye(const Scene& scene, SampleSource& source);
void sample_eye(const Scene& scene, SampleSource& source, Vertex& v);

/// Makes the new vertex `v` the next one along `w`, in its place: vertices are large. False where nothing is hit. It
/// may be infinite where there is an environment: there a walk ends, for nothing is scattered.
bool next_vertex(const Scene& scene, const SurfacePoint& from, const Vec3& w, Vertex& v);
/// The same; none where nothing is hit.
std::optional<Vertex> next_vertex(const Scene& scene, const SurfacePoint& from, const Vec3& w);
inline std::optional<Vertex> next_vertex(const Scene& scene, const Vertex& from, const Vec3& w) {
    return next_vertex(scene, from.point, w);
}

/// Which end of a path a walk comes from. Radiance is scaled by glass and importance by shading normals.
enum class From { eye, light };

/// Where a walk goes on from a vertex.
struct Continuation {
    Vec3 w; ///< unit
    Event event;
    Rgb weight;               ///< factor of the walk's throughput: scattering times cosine over density
    double pdf;               ///< per solid angle; probability of the event where specular
    double forward, backward; ///< densities per solid angle in the convention of measure.h: of `w`, and of `back` for a
                              ///< walk from the other end
};

/// Samples the BSDF at `v`, reached along `back` (unit, pointing back). None: absorbed.
std::optional<Continuation> continue_walk(const Vertex& v, const Vec3& back, From from, SampleSource& source);

/// Probability that continue_walk() takes a finite event, and with that a vertex counts as D.
double finite_probability(const Vertex& v, const Vec3& back);

/// The free flights of a walk. Primaries fly differently: one of the three is drawn for the whole walk, and the density
/// of the walk is the mean over all (after Wilkie et al. 2014, "Hero Wavelength Spectral Sampling"). Drawn anew for
/// each flight, they would let weights grow without bounds.
struct Flight {
    int primary;
    Rgb relative{1.0}; ///< densities of the primaries so far, over their mean

    explicit Flight(double u) : primary(std::min(2, static_cast<int>(3 * u))) {}
    /// By what an edge, flown with these densities, multiplies the density of the walk.
    double arrive(const Rgb& densities);
};

/// The ray of a walk on its way.
struct WalkRay {
    const SurfacePoint* origin; ///< where it is traced from: the walk's last vertex, or on its beam if that is infinite
    const SurfacePoint* last;   ///< the walk's last vertex
    Vec3 w;                     ///< unit
    Rgb throughput{1.0};        ///< contribution over density of the vertices so far, roulette included
    Rgb clear{1.0};             ///< what media leave of light along it, over the density of its flight
    Rgb uncollided{1.0};        ///< Attenuation::uncollided along it
    std::optional<Flight> flight{}; ///< where media scatter, from the first edge on
};

inline double mean_of_primaries(const Rgb& c) { return (c.x + c.y + c.z) / 3; }

/// What media make of the density of a vertex that is drawn by a ray, at the end of an edge, by primary: in one that
/// scatters, the density of a free flight that ends there per length [1/m]; elsewhere the probability that it gets
/// there. Product with solid_angle_to_area().
Rgb flight_densities(const Rgb& uncollided, const Vertex& to);
/// The same of an edge by itself: what techniques are weighed by.
inline double flight_density(const Rgb& uncollided, const Vertex& to) {
    return mean_of_primaries(flight_densities(uncollided, to));
}

/// Makes the new vertex `v` the next one along the ray: what it meets, or where a medium scatters it before that. Notes
/// what media leave of its light. False where there is nothing.
bool follow(const Scene& scene, WalkRay& ray, Vertex& v, SampleSource& source);

/// The ray through window point `image` from the eye vertex at `eye`, which must stay in its place.
inline WalkRay eye_ray(const Scene& scene, const SurfacePoint& eye, const Vec2& image) {
    return {&eye, &eye, scene.camera().ray_direction(eye, image)};
}

/// The first edge of a light path.
struct EmittedLight {
    SurfacePoint x0;
    EmitterRay ray;
    Rgb power; ///< over the density of the choice [W]
};
/// Light that leaves `x0`, chosen with density `pdf`, along `ray`. None where none can.
std::optional<EmittedLight> emit_along(const Scene& scene, const SurfacePoint& x0, double pdf, const EmitterRay& ray);
/// The same along a ray that its emitter draws.
std::optional<EmittedLight> emit_light(const Scene& scene, const SurfacePoint& x0, double pdf, SampleSource& source);
/// From an emitter chosen by power. None where nothing emits.
std::optional<EmittedLight> emit_light(const Scene& scene, SampleSource& source);

} // namespace keyhole
