#include "sampling/guidance/user_paths.h"

#include "core/error.h"
#include "sampling/guidance/nearest_emitter.h"
#include "sampling/paths/measure.h"
#include "sampling/paths/walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace keyhole {
namespace {

std::string text(const Vec3& p) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z); }
std::string text(double distance) { return fmt::format("{:.3g} m", distance); }

double distance_to_edge(const Imath::V3d& p, const Imath::V3d& corner, const Imath::V3d& edge) {
    const double t = std::clamp((p - corner).dot(edge) / edge.length2(), 0.0, 1.0);
    return (p - corner - edge * t).length();
}

/// What a line from `from` along `w` does that doesn't go through the opening.
std::string how_it_misses(const Opening& opening, const Vec3& from, const Vec3& w) {
    const auto& [corner, u, v] = opening;
    const Imath::V3d normal = u.cross(v).normalized(), start(from), along(w);
    const double height = (corner - start).dot(normal), slope = along.dot(normal);
    if (std::abs(height) <= 1e-5 * std::max(u.length(), v.length())) return "begins in the plane of its opening";
    if (!(height * slope > 0)) return "leads away from its opening";
    const Imath::V3d p = start + along * (height / slope);
    const double off = std::min({distance_to_edge(p, corner, u), distance_to_edge(p, corner, v),
                                 distance_to_edge(p, corner + u, v), distance_to_edge(p, corner + v, u)});
    return fmt::format("passes beside its opening: it crosses the plane at {}, {} off", text(Vec3(p)), text(off));
}

/// Finds the points of one path, in order.
class Binder {
  public:
    Binder(const Scene& scene, const UserPathSpec& spec)
        : scene_(scene), spec_(spec),
          tolerance_(spec.tolerance.value_or(0.01 * (scene.upper() - scene.lower()).length())) {}

    UserPath bind() {
        const SurfacePoint light = find_light();
        for (std::size_t i = 1; i < spec_.points.size(); ++i) find(i);
        if (found_.back().specular())
            fail(last(), "found a specular vertex at its end, expected a surface that scatters in all directions");
        const bool seen = is_seen();
        UserPath path{spec_.name, spec_.weight, {scene_, light, spec_.patch}, {}, seen};
        for (std::size_t i = 1; i < found_.size(); ++i)
            path.vertices.push_back(
                {found_[i].point.p, found_[i].event, spec_.beta[i - 1], portal(i), spec_.points[i].bounce});
        return path;
    }

  private:
    std::size_t last() const { return spec_.points.size() - 1; }
    Vec3 given(std::size_t i) const { return Vec3(spec_.points[i].p); }
    std::optional<Portal> portal(std::size_t i) const {
        const auto& through = spec_.points[i].through;
        return through ? std::optional<Portal>({through->corner, through->u, through->v}) : std::nullopt;
    }
    double miss(std::size_t i, const Vec3& p) const { return (Imath::V3d(p) - spec_.points[i].p).length(); }

    [[noreturn]] void fail(std::size_t i, const std::string& message) const {
        throw InputError(spec_.points[i].where, fmt::format("path '{}', point {}: {}", spec_.name, number(i), message));
    }
    /// Place of a point in the file's list, from 1, in which openings and bounces have one as well.
    int number(std::size_t i) const {
        int number = 0;
        for (std::size_t k = 0; k <= i; ++k) {
            const UserPathPoint& p = spec_.points[k];
            if (!p.bounce)
                number += p.through ? 2 : 1;
            else if (k == 1) // one entry for all of them
                ++number;
        }
        return number;
    }
    /// Where the segment to a point begins, in words.
    std::string start(std::size_t i) const {
        return spec_.points[i - 1].bounce ? "the middle of the opening" : fmt::format("point {}", number(i - 1));
    }

    SurfacePoint find_light();
    void find(std::size_t i);
    void aim(std::size_t i);
    void stand_in(std::size_t i);
    void follow(std::size_t i);
    void add(std::size_t i, const Vertex& vertex);
    void check_scattering(std::size_t i, const Vec3& to_eye) const;
    bool is_seen() const;

    const Scene& scene_;
    const UserPathSpec& spec_;
    double tolerance_;
    InlineVector<Vertex, kMostUserPoints + 1> found_;
};

void Binder::find(std::size_t i) {
    if (spec_.points[i].bounce) return stand_in(i);
    i == 1 || !found_.back().specular() ? aim(i) : follow(i);
}

/// A bounce may happen anywhere: for it stands the middle of the opening behind it, from where the next point is aimed
/// at.
void Binder::stand_in(std::size_t i) {
    const auto opening = std::find_if(spec_.points.begin() + static_cast<std::ptrdiff_t>(i), spec_.points.end(),
                                      [](const UserPathPoint& p) { return p.through.has_value(); });
    Vertex v;
    v.point.p = Vec3(opening->through->centre());
    v.point.site = Site::point;
    found_.push_back(v);
}

SurfacePoint Binder::find_light() {
    const auto next =
        std::find_if(spec_.points.begin() + 1, spec_.points.end(), [](const UserPathPoint& p) { return !p.bounce; });
    const bool aimed = !spec_.points[1].bounce; // light that is scattered first may leave in any direction
    const auto nearest = nearest_emitter_point(scene_, spec_.points[0].p, next->p, aimed ? tolerance_ : 0);
    if (!nearest) fail(0, "found no emitter that has a place in the scene, expected an area light or a point light");
    if (nearest->distance > tolerance_)
        fail(0, fmt::format("found the nearest emitter {} away, at {}, expected one within {}", text(nearest->distance),
                            text(nearest->point.p), text(tolerance_)));
    found_.push_back(make_vertex(nearest->point));
    return nearest->point;
}

/// Goes straight from the point before, which scatters or emits in all directions.
void Binder::aim(std::size_t i) {
    const Vertex& from = found_.back();
    if (miss(i, from.point.p) <= 1e-6 * (scene_.upper() - scene_.lower()).length())
        fail(i, fmt::format("found the same place as {}, expected another one", start(i)));
    const auto opening = portal(i);
    if (!opening && !(spec_.beta[i - 1] > 0))
        fail(i, fmt::format("found a cone of no width for the segment from {}, expected beta above 0", start(i)));
    const Vec3 w = (given(i) - from.point.p).normalized();
    const bool anywhere = spec_.points[i - 1].bounce;
    if (opening && !anywhere && !(opening->density(from.point.p, w) > 0))
        fail(i, fmt::format("found that the segment from {} {}", start(i),
                            how_it_misses(*spec_.points[i].through, from.point.p, w)));
    if (i == 1 && is_black(scene_.emitter(from.point.emitter).radiance(from.point, w)))
        fail(0, fmt::format("found an emitter that sends no light towards point {}", number(1)));
    const auto hit = next_vertex(scene_, from, w);
    if (!hit || hit->point.site != Site::surface) fail(i, fmt::format("found no surface on the way from {}", start(i)));
    const double off = miss(i, hit->point.p);
    if (off > tolerance_) {
        const bool before = Vec3(hit->point.p - from.point.p).length() < Vec3(given(i) - from.point.p).length();
        if (before)
            fail(i, fmt::format("found the segment from {} blocked at {}, {} before this point", start(i),
                                text(hit->point.p), text(off)));
        fail(i, fmt::format("found it in the air: the surface on the way from {} is {} behind it, at {}; "
                            "expected one within {}",
                            start(i), text(off), text(hit->point.p), text(tolerance_)));
    }
    add(i, *hit);
}

/// Goes from a mirror or glass where it sends the light: of its lobes, by the one that comes nearest to the point.
void Binder::follow(std::size_t i) {
    Vertex& from = found_.back();
    if (portal(i))
        fail(i, fmt::format("found an opening behind the specular vertex at point {}, where light is not free to aim",
                            number(i - 1)));
    const Vec3 back = direction(from.point, found_[found_.size() - 2].point);
    std::optional<Vertex> best;
    Event event = from.event;
    for (const Event e : {Event::reflect, Event::transmit}) {
        const auto lobe = from.bsdf.delta(back, e);
        if (!lobe) continue;
        const auto hit = next_vertex(scene_, from, lobe->to);
        if (!hit || hit->point.site != Site::surface) continue;
        if (best && miss(i, hit->point.p) >= miss(i, best->point.p)) continue;
        best = *hit;
        event = e;
    }
    if (!best)
        fail(i, fmt::format("found that light leaves the scene from the specular vertex at point {}", number(i - 1)));
    if (const double off = miss(i, best->point.p); off > tolerance_)
        fail(i, fmt::format("found that the specular vertex at point {} sends light to {}, {} away; expected it within "
                            "{} (keyhole paths trace finds such points)",
                            number(i - 1), text(best->point.p), text(off), text(tolerance_)));
    from.event = event;
    add(i, *best);
}

void Binder::add(std::size_t i, const Vertex& vertex) {
    if (i > 1 && !spec_.points[i - 1].bounce) check_scattering(i - 1, direction(found_.back().point, vertex.point));
    found_.push_back(vertex);
    Vertex& v = found_.back();
    const BsdfTraits traits = v.bsdf.traits();
    if (!traits.finite && !traits.delta) fail(i, "found a surface that scatters no light");
    // Follow() makes it what it is; the last one is told by this alone.
    v.event = traits.finite ? Event::finite : Event::reflect;
}

/// Fails if found point i can't send light on along `to_eye`.
void Binder::check_scattering(std::size_t i, const Vec3& to_eye) const {
    const Vertex& v = found_[i];
    if (v.specular()) return;
    const Vec3 to_light = direction(v.point, found_[i - 1].point);
    if (is_black(scatter(v.point, v.bsdf, Event::finite, to_light, to_eye).value))
        fail(i, fmt::format("found a surface that scatters no light from {} to point {}", start(i), number(i + 1)));
}

bool Binder::is_seen() const {
    const Vertex& v = found_.back();
    const SurfacePoint eye = scene_.camera().eye(0, 0);
    const Vec3 w = direction(eye, v.point), to_light = direction(v.point, found_[found_.size() - 2].point);
    return scene_.camera().image_point(eye, w) && scene_.visible(v.point, eye) &&
           !is_black(scatter(v.point, v.bsdf, Event::finite, to_light, -w).value);
}

} // namespace

std::string UserPath::signature() const {
    std::string s = "L";
    for (const UserVertex& v : vertices) s += v.bounce ? " *" : is_specular(v.event) ? " S" : " D";
    return s;
}

UserPath bind_user_path(const Scene& scene, const UserPathSpec& spec) { return Binder(scene, spec).bind(); }

bool binds(const Scene& scene, const UserPathSpec& spec) {
    try {
        bind_user_path(scene, spec);
        return true;
    } catch (const InputError&) {
        return false; // a grazing segment, or rounding along a chain of mirrors
    }
}

UserPaths bind_user_paths(const Scene& scene, const UserPathFile& file) {
    UserPaths paths;
    for (const UserPathSpec& spec : file.paths) paths.push_back(bind_user_path(scene, spec));
    return paths;
}

UserPathFile usable_paths(const Scene& scene, UserPathFile file, std::vector<std::string>& warnings) {
    std::set<std::string> told; // entries: of their paths, which differ in bounces, the first says enough
    std::erase_if(file.paths, [&](const UserPathSpec& spec) {
        try {
            bind_user_path(scene, spec);
            return false;
        } catch (const InputError& e) {
            if (told.insert(spec.where.to_string()).second || spec.where.line == 0)
                warnings.push_back(fmt::format("{}: the path is left out", e.what()));
            return true;
        }
    });
    return file;
}

} // namespace keyhole
