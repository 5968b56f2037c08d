// Clear glass, which light goes straight through: panes without thickness, and flat slabs between a surface and an
// emitter at infinity, which shift light without turning it. What comes so is direct light, for next-event estimation
// finds it by looking through; a density estimate of it would blur the sun's patch on the floor, and blotch the walls
// of every room with glass in its window.
#pragma once

#include "sampling/paths/path.h"
#include "scene/scene.h"

#include <functional>

namespace keyhole {

/// What `v` is to light that goes through. Glass that shines is none: a view ends at the first emitter.
inline ClearGlass clear_glass(const Vertex& v) {
    if (v.point.is_emitter()) return ClearGlass::none;
    const ClearGlass glass = v.bsdf.traits().clear;
    // No two faces of a lens are parallel for more than a point.
    const bool flat = v.point.primitive != SurfacePoint::kNone && v.bsdf.shading_normal() == v.point.ng;
    return glass == ClearGlass::face && !flat ? ClearGlass::none : glass;
}

/// Follows light, from either end, and knows whether it comes straight.
class StraightLight {
  public:
    /// Whether light that is on its way along unit direction `w` has come straight so far. `from_infinity`: whether it
    /// comes from an emitter there.
    bool straight(const Vec3& w, bool from_infinity) const {
        return clear_ && (!turned_ || (from_infinity && (w - first_).length2() < kTurn * kTurn));
    }
    /// It came along `w` and leaves `v` by its event.
    void meet(const Vertex& v, const Vec3& w) {
        if (!clear_) return;
        const ClearGlass glass = v.event == Event::transmit ? clear_glass(v) : ClearGlass::none;
        clear_ = glass != ClearGlass::none;
        if (glass != ClearGlass::face) return;
        if (!turned_) first_ = w;
        turned_ = true;
    }

  private:
    /// What faces of a slab may be off being parallel by, and directions between positions by rounding [rad].
    static constexpr float kTurn = 1e-3f;

    bool clear_ = true, turned_ = false; // through nothing but clear glass; and faces among it
    Vec3 first_{0, 0, 0};                // direction before the first face
};

/// Index of the first vertex from the light's end that light comes straight to, of a path of which `eye` is the eye's:
/// where that is a D, light there is direct. at(i): its vertex i; specular(i) says so of that.
template <class At, class Specular> int first_lit(int eye, const At& at, const Specular& specular) {
    StraightLight light;
    int i = 1;
    for (; i < eye && specular(i); ++i) light.meet(at(i), direction(at(i - 1).point, at(i).point));
    if (i == 1 || i == eye) return 1;
    const bool from_infinity = at(0).point.site == Site::infinite;
    return light.straight(direction(at(i - 1).point, at(i).point), from_infinity) ? i : 1;
}

inline int first_lit(const Path& path) {
    const auto at = [&](int i) -> const Vertex& { return path.x[static_cast<std::size_t>(i)]; };
    return first_lit(path.vertices() - 1, at, [&](int i) { return at(i).specular(); });
}

inline LightClass light_class(const Path& path) { return light_class(diffuse_vertices(path), first_lit(path)); }

/// Faces and panes that are looked through at most.
constexpr int kMostFaces = 64;

/// Share of light that comes straight from `x0`, a point on an emitter, to `from`: what media leave of it and what
/// clear glass lets through; black if anything else stands in between, or more than `most_faces`. Tells `passed`, if
/// any, of each vertex that it goes through, from `from` on, even if something else follows.
Rgb straight_transmittance(const Scene& scene, const SurfacePoint& from, const SurfacePoint& x0,
                           int most_faces = kMostFaces, const std::function<void(const Vertex&)>& passed = {});

/// What is seen straight along unit direction `w`, through clear glass, at most so many faces of it, and the share of
/// its light that comes.
struct StraightView {
    Vertex end;
    Rgb transmittance;
};
/// None where nothing is, or no light comes straight from there.
std::optional<StraightView> look_straight(const Scene& scene, const SurfacePoint& from, const Vec3& w,
                                          int most_faces = kMostFaces);

} // namespace keyhole
