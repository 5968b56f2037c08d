// What the perturbations that retrace a path from the eye's side have in common.
//
// A pivot stays where it is and the direction in which the path leaves it towards the light changes a little. The
// specular events after it are traced again; the non-specular vertex they lead to is joined to the kept rest. Where the
// rest begins with a specular vertex nothing can be joined: then that vertex is the next pivot, and so on, at the
// latest until the light is hit.
#pragma once

#include "sampling/proposals/edit.h"
#include "sampling/proposals/steps.h"

namespace keyhole {

/// One traced piece of a perturbed path: x[pivot] stays finite, x[last] is the finite vertex that is reached.
struct Piece {
    int pivot, last;
};

/// The pieces that have to be traced when x[pivot] is the first pivot, in order. The last one ends where a connection
/// is possible, or on the light (last == 0).
using Pieces = InlineVector<Piece, kMaxScatterings + 2>;
Pieces pieces_from_eye(const Path& x, int pivot);

/// How a piece begins that leaves the eye's side.
struct EyeEdge {
    Vec3 w;     ///< unit
    Vec2 image; ///< window point of the whole path
};

/// Traces the pieces from `edge` on, those after the first with directions perturbed by `step`, and evaluates the path.
/// `eye`: the kept vertices, with the first pivot as the last of them.
std::optional<Path> perturb_from_eye(const Scene& scene, PathSet set, const Path& x, const Pieces& pieces, SubPath& eye,
                                     const EyeEdge& edge, const DirectionStep& step, SampleSource& source,
                                     Failure& why);

/// Density of the traced vertices of y, made from x with `pieces`. `first_density`: that of the first traced vertex.
double eye_perturbation_density(const Path& x, const Path& y, const Pieces& pieces, double first_density,
                                const DirectionStep& step);

} // namespace keyhole
