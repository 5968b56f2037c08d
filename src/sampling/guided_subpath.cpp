#include "sampling/guided_subpath.h"

#include "sampling/proposals/steps.h"

namespace keyhole {
namespace {

/// Unit direction from a vertex towards a user's point.
Vec3 axis(const Vertex& from, const UserVertex& to) { return (to.p - from.point.p).normalized(); }

} // namespace

GuidedSubPath::GuidedSubPath(const Scene& scene, const UserPath& path) : scene_(&scene), path_(path) {
    events_.x.push_back({});
    for (const UserVertex& v : path.vertices) {
        events_.x.push_back({});
        events_.x.back().event = v.event;
    }
}

/// Towards user vertex i.
Vec3 GuidedSubPath::sample_direction(const Vertex& from, int i, Rng& rng) const {
    const UserVertex& to = user_vertex(i);
    return to.portal ? to.portal->sample(from.point.p, rng) : Cone(to.beta).sample(axis(from, to), rng);
}

/// Per solid angle.
double GuidedSubPath::direction_density(const Vertex& from, const Vec3& w, int i) const {
    const UserVertex& to = user_vertex(i);
    return to.portal ? to.portal->density(from.point.p, w) : Cone(to.beta).density(axis(from, to), w);
}

/// Goes where light goes that is emitted or scattered finitely.
bool GuidedSubPath::bounce(SubPath& light, Rng& rng, Failure& why) const {
    if (!grow(*scene_, light, From::light, Vec2(0, 0), true, rng, why)) return false;
    light.back().event = Event::finite;
    return light.back().bsdf.traits().finite || (why = Failure::signature, false);
}

bool GuidedSubPath::trace(SubPath& light, Rng& rng, Failure& why) const {
    light.push_back(make_vertex(path_.patch.sample(rng)));
    const int last = vertices() - 1;
    for (int i = 0; i < last;) {
        const int next = next_finite(events_, i, +1);
        if (user_vertex(i + 1).bounce) {
            if (!bounce(light, rng, why)) return false;
            i = next;
            continue;
        }
        const Vec3 w = sample_direction(light.back(), i + 1, rng);
        if (!retrace(*scene_, light, light.back().point, w, events_, i + 1, next, why)) return false;
        i = next;
    }
    return true;
}

double GuidedSubPath::density(const Path& y) const {
    const int last = vertices() - 1;
    if (last >= y.vertices()) return 0;
    for (int i = 1; i <= last; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (y.x[k].event != events_.x[k].event) return 0;
    }
    double density = path_.patch.pdf(y.x[0].point);
    for (int i = 0; i < last && density > 0;) {
        const int next = next_finite(events_, i, +1);
        const Vertex &from = y.x[static_cast<std::size_t>(i)], &to = y.x[static_cast<std::size_t>(i) + 1];
        if (user_vertex(i + 1).bounce) {
            density *= to.pdf_from_light;
        } else {
            const double w = direction_density(from, leaving_direction(y, i, +1), i + 1);
            density *= w > 0 ? retrace_density(y, solid_angle_to_area(w, from.point, to.point), i + 1, next) : 0.0;
        }
        i = next;
    }
    return density;
}

} // namespace keyhole
