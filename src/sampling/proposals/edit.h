// What the proposals share: comparing and cutting paths, growing sub-paths, joining them.
#pragma once

#include "sampling/markov/mixture.h"
#include "sampling/paths/measure.h"
#include "sampling/paths/path.h"
#include "sampling/paths/walk.h"
#include "scene/scene.h"

namespace keyhole {

/// A sub-path that grows away from its end: [0] is the light or the eye.
using SubPath = InlineVector<Vertex, kMaxScatterings + 2>;

inline bool same_place(const Vertex& a, const Vertex& b) {
    return a.point.p == b.point.p && a.event == b.event && a.point.emitter == b.point.emitter;
}

/// Number of leading vertices that two paths have in common.
inline int common_prefix(const Path& x, const Path& y) {
    const std::size_t most = std::min(x.x.size(), y.x.size());
    std::size_t i = 0;
    while (i < most && same_place(x.x[i], y.x[i])) ++i;
    return static_cast<int>(i);
}

/// Number of trailing vertices that two paths have in common, apart from their first `prefix`.
inline int common_suffix(const Path& x, const Path& y, int prefix) {
    const int most = std::min(x.vertices(), y.vertices()) - prefix;
    int i = 0;
    while (i < most && same_place(x.x[x.vertices() - 1 - i], y.x[y.vertices() - 1 - i])) ++i;
    return i;
}

/// Whether an edge between these two can be made by joining rather than by tracing.
inline bool joinable(const Vertex& a, const Vertex& b) { return !a.specular() && !b.specular(); }

/// Index of d1 if the edge on its light side is joinable, which makes everything from d1 to the eye a lens sub-path
/// that can be replaced; 0 otherwise.
inline int lens_subpath_start(const Path& path) {
    const int d1 = nth_finite_from_eye(path, 1);
    return d1 > 0 && !path.x[d1 - 1].specular() ? d1 : 0;
}

/// Adds the vertex that `walk` meets next, sampling the event at its last vertex; from the eye alone along `image`.
/// `kept`: the last vertex belongs to the old path, where it scatters finitely, and must go on doing so.
bool grow(const Scene& scene, SubPath& walk, From from, const Vec2& image, bool kept, SampleSource& source,
          Failure& why);

/// Path from a light sub-path and an eye sub-path, in order from the light.
void assemble(Path& path, const SubPath& light, const SubPath& eye);

/// The evaluated path that joins the last vertices of two sub-paths; none if blocked, or outside the image: a path that
/// is joined to the eye itself has the image point that follows. No `light`: the eye sub-path met the emitter.
std::optional<Path> join(const Scene& scene, PathSet set, const SubPath& light, const SubPath& eye, const Vec2& image,
                         Failure& why);

/// Adds to `walk` the vertices that a ray from `origin` along `w` meets, to correspond to x[first], ..., x[last] in
/// this order (towards the light if last < first). Those before the last take the specular events that x has there; the
/// last is finite. `origin` is the last vertex of the walk, or on its beam where that is infinite. A step that is lost
/// when positions are rounded, where surfaces all but touch, fails: it has no density, and none the other way round.
bool retrace_specular_chain(const Scene& scene, SubPath& walk, SurfacePoint origin, Vec3 w, const Path& x, int first,
                            int last, Failure& why);

/// Density of y[first], ..., y[last] (all but the last specular) when traced in this order: `first_density`, that of
/// y[first], times those of the others, with specular events prescribed, not chosen.
double specular_chain_density(const Path& y, double first_density, int first, int last);

/// Index of the next non-specular vertex from `i` in direction `step` (+1 towards the eye, -1 towards the light), not
/// counting i itself. The ends of a path are never specular.
int next_finite(const Path& path, int i, int step);

/// Unit direction from x[i] to its neighbour x[i + step].
Vec3 leaving_direction(const Path& path, int i, int step);

/// Whether two paths have the same vertices specular in the same way.
bool same_events(const Path& x, const Path& y);

/// What a proposal keeps of a path of n vertices when it replaces a part of it: x[0..light] and x[eye..n-1]. light = -1
/// and eye = n: nothing on that side. Kept ends are non-specular: beyond a specular vertex nothing is free to choose,
/// and the same path would be made with several deletions. Likewise the eye is always replaced together with the edge
/// that leaves it, and a point light together with the edge that leaves it: a second way to the same path would have to
/// be summed.
struct Cut {
    int light, eye;
    int removed() const { return eye - light - 1; }
    friend bool operator==(const Cut&, const Cut&) = default;
};

/// Whether x[i] may be the last vertex that is kept on the light's side.
bool can_keep_light(const Scene& scene, const Path& x, int i);
/// Whether x[i] may be the first vertex that is kept on the eye's side.
inline bool can_keep_eye(const Path& x, int i) { return !x.x[i].specular(); }

/// The cut by which y came from x: what the two have in common, but for ends that are never kept. The new vertices of y
/// are what a transition density has to be a density of.
Cut cut_between(const Scene& scene, const Path& x, const Path& y);

/// Whether nothing of y came from x.
inline bool is_all_new(const Scene& scene, const Path& x, const Path& y) {
    return cut_between(scene, x, y) == Cut{-1, x.vertices()};
}

} // namespace keyhole
