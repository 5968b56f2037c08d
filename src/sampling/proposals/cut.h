// What a proposal keeps of a path when it replaces a part of it.
//
// Kept ends are non-specular: beyond a specular vertex nothing is free to choose, and the same path would be made with
// several deletions. Likewise the eye is always replaced together with the edge that leaves it, and a point light
// together with the edge that leaves it: a second way to the same path would have to be summed.
#pragma once

#include "sampling/paths/path.h"
#include "scene/scene.h"

namespace keyhole {

/// What stays of a path of n vertices: x[0..light] and x[eye..n-1]. light = -1 and eye = n: nothing on that side.
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

} // namespace keyhole
