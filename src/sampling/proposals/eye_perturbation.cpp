#include "sampling/proposals/eye_perturbation.h"

namespace keyhole {

Pieces pieces_from_eye(const Path& x, int pivot) {
    Pieces pieces;
    for (;;) {
        const int last = next_finite(x, pivot, -1);
        pieces.push_back({pivot, last});
        if (last == 0 || !x.x[last - 1].specular()) return pieces;
        pivot = last;
    }
}

std::optional<Path> perturb_from_eye(const Scene& scene, PathSet set, const Path& x, const Pieces& pieces, SubPath& eye,
                                     const EyeEdge& edge, const DirectionStep& step, SampleSource& source,
                                     Failure& why) {
    Vec3 w = edge.w;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Piece& piece = pieces[i];
        if (i > 0) w = step.sample(leaving_direction(x, piece.pivot, -1), source);
        if (!retrace_specular_chain(scene, eye, eye.back().point, w, x, piece.pivot - 1, piece.last, why))
            return std::nullopt;
    }
    const int last = pieces.back().last;
    if (last == 0 && !eye.back().point.is_emitter()) return why = Failure::no_light, std::nullopt;
    SubPath light;
    for (int i = 0; i < last; ++i) light.push_back(x.x[i]);
    return join(scene, set, light, eye, edge.image, why);
}

double eye_perturbation_density(const Path& x, const Path& y, const Pieces& pieces, double first_density,
                                const DirectionStep& step) {
    double density = specular_chain_density(y, first_density, pieces[0].pivot - 1, pieces[0].last);
    for (std::size_t i = 1; i < pieces.size(); ++i) {
        const auto [pivot, last] = pieces[i];
        const double w = step.density(leaving_direction(x, pivot, -1), leaving_direction(y, pivot, -1));
        density *=
            specular_chain_density(y, solid_angle_to_area(w, y.x[pivot].point, y.x[pivot - 1].point), pivot - 1, last);
    }
    return density;
}

} // namespace keyhole
