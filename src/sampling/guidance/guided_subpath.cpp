#include "sampling/guidance/guided_subpath.h"

#include "sampling/proposals/steps.h"

namespace keyhole {
namespace {

/// Bounces that light is followed back from a portal, at most.
constexpr int kMostBack = 3;

/// Unit direction from a vertex towards a user's point.
Vec3 axis(const Vertex& from, const UserVertex& to) { return (to.p - from.point.p).normalized(); }

} // namespace

GuidedSubPath::GuidedSubPath(const Scene& scene, const UserPath& path) : scene_(&scene), path_(path) {
    events_.x.push_back({});
    for (const UserVertex& v : path.vertices) {
        events_.x.push_back({});
        events_.x.back().event = v.event;
    }
    for (int i = 2; i < vertices() && crossed_ == 0; ++i)
        if (user_vertex(i).portal && user_vertex(i - 1).bounce && !is_specular(user_vertex(i).event)) crossed_ = i;
    for (int i = crossed_ - 1; i > 0 && user_vertex(i).bounce && most_back_ < kMostBack; --i) ++most_back_;
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

double GuidedSubPath::probability_of_back(int back) const {
    return most_back_ < 0 ? 1.0 : back < 0 ? 0.5 : 0.5 / (most_back_ + 1);
}

bool GuidedSubPath::cross(SubPath& light, int back, Rng& rng, Failure& why) const {
    const Portal& portal = *user_vertex(crossed_).portal;
    const SurfacePoint &lamp = light[0].point, &before = light.back().point;
    const Portal::Line line = portal.sample_line(lamp.p, rng);
    SurfacePoint middle;
    middle.p = line.p;
    middle.site = Site::point;
    const auto scatters = [&](const std::optional<Vertex>& v) {
        if (!v) return why = Failure::no_hit, false;
        return (v->point.site == Site::surface && v->bsdf.traits().finite) || (why = Failure::signature, false);
    };
    const auto near = next_vertex(*scene_, middle, -line.w);
    if (!scatters(near)) return false;
    // From the surface and not from the middle: there may be a pane.
    const auto far = next_vertex(*scene_, *near, direction(near->point, middle));
    if (!scatters(far)) return false;
    if (!(portal.line_density(lamp.p, near->point.p, far->point.p) > 0)) return why = Failure::signature, false;
    InlineVector<Vertex, kMostBack + 2> found; // from beyond the portal back
    found.push_back(*far);
    found.push_back(*near);
    for (int i = 0; i < back; ++i) {
        const Vertex& from = found.back();
        const auto next = continue_walk(from, direction(from.point, found[found.size() - 2].point), From::eye, rng);
        if (!next) return why = Failure::absorbed, false;
        if (is_specular(next->event)) return why = Failure::signature, false;
        const auto v = next_vertex(*scene_, from, next->w);
        if (!scatters(v)) return false;
        found.push_back(*v);
    }
    if (!scene_->visible(before, found.back().point)) return why = Failure::blocked, false;
    for (std::size_t i = found.size(); i-- > 0;) {
        light.push_back(found[i]);
        light.back().event = Event::finite;
    }
    return true;
}

bool GuidedSubPath::through_portal(const Vertex& from, const Vertex& to, int i) const {
    const auto& portal = user_vertex(i).portal;
    return !portal || portal->separates(from.point.p, to.point.p);
}

double GuidedSubPath::cross_density(const Path& y, int back) const {
    const auto point = [&](int i) -> const SurfacePoint& { return y.x[i].point; };
    const SurfacePoint &near = point(crossed_ - 1), &far = point(crossed_);
    const double line = user_vertex(crossed_).portal->line_density(point(0).p, near.p, far.p);
    double density = line > 0 ? line * geometry_term(near, far) : 0.0;
    for (int i = crossed_ - 1; i > crossed_ - 1 - back && density > 0; --i) {
        const Vertex& v = y.x[i];
        const SurfacePoint &before = point(i - 1), &after = point(i + 1);
        const ScatterValue s =
            scatter(v.point, v.bsdf, Event::finite, direction(v.point, before), direction(v.point, after));
        density *= solid_angle_to_area(s.pdf_to_light, v.point, before);
    }
    return density;
}

bool GuidedSubPath::trace(SubPath& light, Rng& rng, Failure& why) const {
    light.push_back(make_vertex(path_.patch.sample(rng)));
    const int last = vertices() - 1;
    int back = -1;
    if (most_back_ >= 0)
        for (double u = rng.next(); back < most_back_ && u >= probability_of_back(back);)
            u -= probability_of_back(back++);
    for (int i = 0; i < last;) {
        if (back >= 0 && i + 2 + back == crossed_) {
            if (!cross(light, back, rng, why)) return false;
            i = crossed_;
            continue;
        }
        const int next = next_finite(events_, i, +1);
        if (user_vertex(i + 1).bounce) {
            if (!bounce(light, rng, why)) return false;
            i = next;
            continue;
        }
        const Vec3 w = sample_direction(light.back(), i + 1, rng);
        if (!retrace_specular_chain(*scene_, light, light.back().point, w, events_, i + 1, next, why)) return false;
        if (!through_portal(light[i], light[i + 1], i + 1)) return why = Failure::blocked, false;
        i = next;
    }
    return true;
}

double GuidedSubPath::density(const Path& y) const {
    const int last = vertices() - 1;
    if (last >= y.vertices()) return 0;
    for (int i = 1; i <= last; ++i)
        if (y.x[i].event != events_.x[i].event || !through_portal(y.x[i - 1], y.x[i], i)) return 0;
    double density = path_.patch.pdf(y.x[0].point), by_line = 0;
    for (int i = 0; i < last && density + by_line > 0;) {
        for (int back = 0; back <= most_back_; ++back)
            if (i + 2 + back == crossed_) by_line += probability_of_back(back) * density * cross_density(y, back);
        const int next = next_finite(events_, i, +1);
        const Vertex &from = y.x[i], &to = y.x[i + 1];
        if (user_vertex(i + 1).bounce) {
            density *= to.pdf_from_light;
        } else {
            const double w = direction_density(from, leaving_direction(y, i, +1), i + 1);
            density *=
                w > 0 ? specular_chain_density(y, solid_angle_to_area(w, from.point, to.point), i + 1, next) : 0.0;
        }
        i = next;
        if (i == crossed_) {
            density = probability_of_back(-1) * density + by_line;
            by_line = 0;
        }
    }
    return density;
}

} // namespace keyhole
