#include "sampling/proposals/mirrored_light_paths.h"

namespace keyhole {
namespace {

/// Rounding allowed of the length of an unfolded path. Beyond it lies what is on the other side of a mirror.
constexpr double kSameLength = 1e-4;

double length(const SurfacePoint& a, const SurfacePoint& b) { return (Imath::V3d(b.p) - Imath::V3d(a.p)).length(); }

/// Density of y[last + 1], ..., y[eye - 1], which follow from the two ends. In measure.h each specular vertex counts as
/// if it had an area measure: that is the product of cos / r^2 over the edges by which the path is traced from the eye,
/// over cos / r^2 of the unfolded edge.
double mirrored_density(const Path& y, int last, int eye) {
    double unfolded = 0, density = 1;
    for (int i = last; i < eye; ++i) {
        const double r = length(y.x[i].point, y.x[i + 1].point);
        unfolded += r;
        density /= r * r;
        if (i > last) density *= y.x[i].point.abs_cos(leaving_direction(y, i, 1));
    }
    return density * unfolded * unfolded;
}

} // namespace

std::optional<Path> MirroredLightPaths::draw(Rng& rng, Failure& why) const {
    SubPath light, eye;
    if (!walk_.trace(light, rng, why)) return std::nullopt;
    eye.push_back(sample_eye(scene_, rng));
    const MirrorImages::Way& way = mirrors_.choose(rng.next());
    const Imath::V3d unfolded = mirrors_.image(way, Imath::V3d(light.back().point.p)) - Imath::V3d(eye[0].point.p);
    const Vec3 w(unfolded.normalized());
    const auto image = scene_.camera().image_point(eye[0].point, w);
    if (!image) return why = Failure::outside_image, std::nullopt;
    if (!meet_mirrors(eye, way, w, why)) return std::nullopt;
    double folded = length(eye.back().point, light.back().point);
    for (std::size_t i = 1; i < eye.size(); ++i) folded += length(eye[i - 1].point, eye[i].point);
    if (!(std::abs(folded - unfolded.length()) <= kSameLength * folded)) return why = Failure::blocked, std::nullopt;
    if (static_cast<int>(light.size() + eye.size()) - 2 > most_) return why = Failure::length, std::nullopt;
    return join(scene_, set_, light, eye, *image, why);
}

double MirroredLightPaths::draw_density(const Path& y) const {
    const int eye = y.vertices() - 1, last = next_finite(y, eye, -1);
    if (last == eye - 1) return 0;
    const double way = mirrors_.probability(way_between(y, last, eye));
    return way > 0 ? way * walk_.density(y, last) * y.x[eye].pdf_from_eye * mirrored_density(y, last, eye) : 0;
}

/// Adds the vertices on the mirrors of `way` that a ray along `w` meets.
bool MirroredLightPaths::meet_mirrors(SubPath& eye, const MirrorImages::Way& way, Vec3 w, Failure& why) const {
    SurfacePoint origin = eye[0].point;
    for (const int mirror : way) {
        if (mirror == MirrorImages::kNone) break;
        auto hit = next_vertex(scene_, origin, w);
        if (!hit || mirrors_.find(hit->point) != mirror) return why = Failure::blocked, false;
        const auto lobe = hit->bsdf.delta(-w, Event::reflect);
        if (!lobe) return why = Failure::signature, false;
        hit->event = Event::reflect;
        eye.push_back(*hit);
        origin = hit->point;
        w = lobe->to;
    }
    return true;
}

/// The mirrors between y[last] and the eye; one that no way is like where there is something else between them.
MirrorImages::Way MirroredLightPaths::way_between(const Path& y, int last, int eye) const {
    MirrorImages::Way way;
    way.fill(MirrorImages::kNone);
    if (eye - last - 1 > MirrorImages::kMostMirrors) return way;
    for (int i = eye - 1; i > last; --i) {
        const int mirror = y.x[i].event == Event::reflect ? mirrors_.find(y.x[i].point) : MirrorImages::kNone;
        if (mirror == MirrorImages::kNone) return way.fill(MirrorImages::kNone), way;
        way[static_cast<std::size_t>(eye - 1 - i)] = mirror;
    }
    return way;
}

} // namespace keyhole
