#include "sampling/guidance/found/opening_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace keyhole {
namespace {

/// Planes that are tried, and when a blocker lies in one: sine of the angle between the normals, and distance as a
/// share of the scene's size. So many blockers of a passage have to.
constexpr std::size_t kPlanes = 192;
constexpr double kParallel = 0.02, kInPlane = 1e-3;
constexpr std::ptrdiff_t kLeastBlockers = 4;
/// Blockers surround a passage up to so far from it, as a share of its length.
constexpr double kAround = 0.3;
/// Passages that an opening has to have, and ends that are asked which places are open, at most.
constexpr std::size_t kLeastPassages = 2, kAsked = 16;
/// Rays that look for an edge: directions in the plane, the first step as a share of the scene's size, halvings.
constexpr int kDirections = 32, kHalvings = 14;
constexpr double kFirstStep = 2e-5, kLongest = 0.5;
/// An edge is measured a little too short: what lies beside the opening found would come without help.
constexpr double kMargin = 0.01;

struct Plane {
    Imath::V3d p, n; // n: unit
};

/// Where the line of a passage crosses a plane; none where it does not.
std::optional<Imath::V3d> crossing(const Passage& passage, const Plane& plane) {
    const Imath::V3d a(passage.light.point.p), b(passage.eye.point.p);
    const double from = (a - plane.p).dot(plane.n), to = (b - plane.p).dot(plane.n);
    if (!(from * to < 0)) return std::nullopt;
    return a + (b - a) * (from / (from - to));
}

double length(const Passage& passage) { return (passage.eye.point.p - passage.light.point.p).length(); }

/// Whether a passage leads through an opening of this plane.
bool is_of(const Passage& passage, const Plane& plane, double size) {
    const auto at = crossing(passage, plane);
    if (!at) return false;
    const double reach = kAround * length(passage);
    return std::ranges::count_if(passage.blockers, [&](const Blocker& b) {
               const Imath::V3d p(b.p), n(b.n);
               return std::abs((p - plane.p).dot(plane.n)) < kInPlane * size && n.cross(plane.n).length() < kParallel &&
                      (p - *at).length() < reach;
           }) >= kLeastBlockers;
}

/// The plane that most passages lead through; none where no two do.
std::optional<Plane> shared_plane(std::span<const Passage> passages, double size) {
    std::vector<Plane> planes;
    for (const Passage& passage : passages)
        for (const Blocker& b : passage.blockers) planes.push_back({Imath::V3d(b.p), Imath::V3d(b.n)});
    std::optional<Plane> best;
    std::ptrdiff_t most = kLeastPassages - 1;
    const std::size_t step = std::max<std::size_t>(1, planes.size() / kPlanes);
    for (std::size_t i = 0; i < planes.size(); i += step) {
        const auto count = std::ranges::count_if(passages, [&](const Passage& p) { return is_of(p, planes[i], size); });
        if (count > most) {
            most = count;
            best = planes[i];
        }
    }
    return best;
}

/// Which places of a plane are open, as seen from the ends of passages on the light's side.
class OpenPlaces {
  public:
    OpenPlaces(const Scene& scene, const Plane& plane, double size) : scene_(scene), plane_(plane), size_(size) {
        const Imath::V3d helper = std::abs(plane.n.x) < 0.9 ? Imath::V3d(1, 0, 0) : Imath::V3d(0, 1, 0);
        s_ = plane.n.cross(helper).normalized();
        t_ = plane.n.cross(s_);
    }
    void add(const Passage& passage) {
        if (asked_.size() < kAsked) asked_.push_back(passage.light);
    }

    bool operator()(const Imath::V3d& y) const {
        return std::ranges::any_of(asked_, [&](const TransportEnd& end) {
            const Imath::V3d offset = y - Imath::V3d(end.point.p);
            const double distance = offset.length();
            const Vec3 w(offset / distance);
            if (!(end.n.dot(w) > 0)) return false;
            const auto hit = scene_.trace(end.point, w);
            return !hit || hit->site != Site::surface ||
                   (hit->p - end.point.p).length() > (1 + kInPlane) * distance + 0.1 * kInPlane * size_;
        });
    }
    /// How far the opening goes from the open place y along unit direction d.
    double extent(const Imath::V3d& y, const Imath::V3d& d) const {
        double open = 0, closed = kFirstStep * size_;
        while ((*this)(y + d * closed)) {
            open = closed;
            closed *= 2;
            if (closed > kLongest * size_) return open;
        }
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = (open + closed) / 2;
            ((*this)(y + d * middle) ? open : closed) = middle;
        }
        return closed;
    }
    Imath::V3d direction(double angle) const { return s_ * std::cos(angle) + t_ * std::sin(angle); }

  private:
    const Scene& scene_;
    Plane plane_;
    double size_;
    Imath::V3d s_, t_; // axes of the plane
    std::vector<TransportEnd> asked_;
};

/// Direction of the longest straight edges, up to a right angle, of an opening whose edge is at `edge` in directions at
/// even angles.
double edge_angle(const std::array<double, kDirections>& edge) {
    struct Side {
        double angle, length;
    };
    constexpr double kStep = 2 * std::numbers::pi / kDirections, kQuarter = std::numbers::pi / 2, kSame = 0.03;
    std::array<Side, kDirections> sides;
    const auto at = [&](int i) {
        const int k = i % kDirections;
        return Imath::V2d(std::cos(k * kStep), std::sin(k * kStep)) * edge[static_cast<std::size_t>(k)];
    };
    for (int i = 0; i < kDirections; ++i) {
        const Imath::V2d d = at(i + 1) - at(i);
        const double angle = std::fmod(std::atan2(d.y, d.x) + 2 * std::numbers::pi, kQuarter);
        sides[static_cast<std::size_t>(i)] = {angle, d.length()};
    }
    double best = 0, most = -1;
    for (const Side& side : sides) {
        double sum = 0;
        for (const Side& other : sides) {
            const double off = std::abs(side.angle - other.angle);
            if (std::min(off, kQuarter - off) < kSame) sum += other.length;
        }
        if (sum > most) {
            most = sum;
            best = side.angle;
        }
    }
    return best;
}

/// A rectangle, by its middle, half its edges and their unit directions.
struct Extents {
    Imath::V3d middle, u, v;
    double along = 0, across = 0;

    /// Across from the middle of each chord: the first place may lie where the opening is narrower.
    void measure(const OpenPlaces& open) {
        for (int round = 0; round < 2; ++round) {
            along = std::max(along, centre(open, u));
            across = std::max(across, centre(open, v));
        }
    }
    /// Turned so that the longer edges agree with what is open at both ends: where an opening is a thousand times as
    /// long as wide, the angle between two places nearby would not do.
    void turn(const OpenPlaces& open) {
        const bool u_is_longer = along > across;
        const Imath::V3d longer = u_is_longer ? u * along : v * across, shorter = u_is_longer ? v : u;
        std::array<double, 2> at{};
        for (std::size_t k = 0; k < 2; ++k) {
            const Imath::V3d y = middle + longer * (k == 0 ? -0.8 : 0.8);
            if (!open(y)) return;
            at[k] = (open.extent(y, shorter) - open.extent(y, -shorter)) / 2;
        }
        const Imath::V3d turned = (longer * 1.6 + shorter * (at[1] - at[0])).normalized();
        const Imath::V3d normal = u.cross(v);
        (u_is_longer ? u : v) = turned;
        (u_is_longer ? v : u) = u_is_longer ? normal.cross(turned) : turned.cross(normal);
    }

  private:
    /// Moves the middle to that of the chord along unit direction d. Returns half its length.
    double centre(const OpenPlaces& open, const Imath::V3d& d) {
        const double forth = open.extent(middle, d), back = open.extent(middle, -d);
        middle += d * ((forth - back) / 2);
        return (forth + back) / 2;
    }
};

/// The rectangle about y whose sides lie along and across its longest edges.
Opening rectangle(const OpenPlaces& open, const Imath::V3d& y) {
    std::array<double, kDirections> edge{};
    for (int i = 0; i < kDirections; ++i)
        edge[static_cast<std::size_t>(i)] = open.extent(y, open.direction(2 * std::numbers::pi * i / kDirections));
    const double angle = edge_angle(edge);
    Extents found{y, open.direction(angle), open.direction(angle + std::numbers::pi / 2)};
    found.measure(open);
    found.turn(open);
    found.along = found.across = 0;
    found.measure(open);
    const Imath::V3d u = found.u * (found.along * (1 + kMargin)), v = found.v * (found.across * (1 + kMargin));
    return {found.middle - u - v, u * 2, v * 2};
}

bool contains(const Opening& opening, const Imath::V3d& p) {
    const Imath::V3d offset = p - opening.corner;
    const double along = offset.dot(opening.u) / opening.u.length2(),
                 across = offset.dot(opening.v) / opening.v.length2();
    return along >= 0 && along <= 1 && across >= 0 && across <= 1;
}

} // namespace

std::optional<FoundOpening> take_opening(const Scene& scene, std::vector<Passage>& passages) {
    const double size = (scene.upper() - scene.lower()).length();
    while (const auto plane = shared_plane(passages, size)) {
        OpenPlaces open(scene, *plane, size);
        for (const Passage& p : passages)
            if (is_of(p, *plane, size)) open.add(p);
        const auto first = std::ranges::find_if(passages, [&](const Passage& p) { return is_of(p, *plane, size); });
        const Imath::V3d y = *crossing(*first, *plane);
        if (!open(y)) {
            passages.erase(first);
            continue;
        }
        FoundOpening found{rectangle(open, y), {}};
        std::erase_if(passages, [&](const Passage& p) {
            const auto at = crossing(p, *plane);
            const bool through = at && contains(found.opening, *at);
            if (through) found.passages.push_back(p);
            return through;
        });
        if (found.passages.size() >= kLeastPassages) return found;
        if (found.passages.empty()) passages.erase(passages.begin()); // never the same again
    }
    return std::nullopt;
}

} // namespace keyhole
