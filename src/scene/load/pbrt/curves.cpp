#include "scene/load/pbrt/curves.h"

#include "scene/load/load_mesh.h"

#include <fmt/format.h>

#include <array>
#include <span>

namespace keyhole::pbrt {
namespace {

/// Vectors of a parameter, of which each coordinate is within what meshes may have.
std::vector<Vec3> bounded_vectors(Parameters& p, std::string_view name, std::string_view type) {
    const std::vector<double> n = p.numbers(name, {type});
    for (const double x : n)
        if (!(std::abs(x) <= static_cast<double>(kMaxMeshCoordinate)))
            p.directive().fail(*p.find(name),
                               fmt::format("found {} in '{}', expected a coordinate within 1e12", x, name));
    std::vector<Vec3> v;
    v.reserve(n.size() / 3);
    for (std::size_t i = 0; i + 2 < n.size(); i += 3) v.emplace_back(n[i], n[i + 1], n[i + 2]);
    return v;
}

using Cubic = std::array<Vec3, 4>;

/// The same curve as one of degree 3.
Cubic elevated(const Vec3& a, const Vec3& b, const Vec3& c) { return {a, (a + b * 2) / 3.0f, (c + b * 2) / 3.0f, c}; }

/// The segment of a uniform B-spline, of as many points as its degree and one.
Cubic spline_segment(std::span<const Vec3> p) {
    if (p.size() == 3) return elevated((p[0] + p[1]) / 2.0f, p[1], (p[1] + p[2]) / 2.0f);
    return {(p[0] + p[1] * 4 + p[2]) / 6.0f, (p[1] * 2 + p[2]) / 3.0f, (p[1] + p[2] * 2) / 3.0f,
            (p[1] + p[2] * 4 + p[3]) / 6.0f};
}

/// One of words, the first of which is the default.
std::string read_word(Parameters& p, std::string_view name, const std::vector<std::string_view>& words) {
    const std::string word = p.string(name, std::string(words.front()));
    if (std::find(words.begin(), words.end(), word) == words.end())
        p.directive().fail(*p.find(name),
                           fmt::format("found '{}' as '{}', {}", word, name, expected_one_of(word, words)));
    return word;
}

/// Segments end to end, each of which is cubic.
std::vector<Vec3> read_segments(Parameters& p) {
    const std::vector<Vec3> points = bounded_vectors(p, "P", "point3");
    const bool is_spline = read_word(p, "basis", {"bezier", "bspline"}) == "bspline";
    const auto degree = static_cast<std::size_t>(p.integer("degree", 3, 2, 3));
    if (points.empty()) p.fail("found no 'P', expected the points of a curve");
    const bool whole = is_spline || (points.size() - 1) % degree == 0;
    if (points.size() <= degree || !whole)
        p.directive().fail(*p.find("P"), fmt::format("found {} points in 'P', expected {}{}", points.size(), degree + 1,
                                                     is_spline ? " or more for a B-spline of that degree"
                                                               : fmt::format(", and {} for each further segment of a "
                                                                             "Bezier curve of that degree",
                                                                             degree)));
    std::vector<Vec3> segments;
    for (std::size_t i = 0; i + degree < points.size(); i += is_spline ? 1 : degree) {
        const std::span<const Vec3> part(points.data() + i, degree + 1);
        const Cubic cubic = is_spline     ? spline_segment(part)
                            : degree == 2 ? elevated(part[0], part[1], part[2])
                                          : Cubic{part[0], part[1], part[2], part[3]};
        segments.insert(segments.end(), cubic.begin() + (segments.empty() ? 0 : 1), cubic.end());
    }
    return segments;
}

/// Those of a ribbon, unit.
std::vector<Vec3> read_ribbon_normals(Parameters& p, std::size_t segments) {
    std::vector<Vec3> normals = bounded_vectors(p, "N", "normal");
    if (normals.size() != segments + 1)
        p.fail(
            fmt::format("found {} normals in 'N', expected {} of a ribbon: one where each segment begins, and one at "
                        "the end",
                        normals.size(), segments + 1));
    for (Vec3& n : normals) {
        n.normalize();
        if (!(n.length2() > 0)) p.directive().fail(*p.find("N"), "found a normal 0 0 0, expected one with a length");
    }
    return normals;
}

} // namespace

void CurveSet::append(const CurveSet& more) {
    curves.insert(curves.end(), more.curves.begin(), more.curves.end());
    points.insert(points.end(), more.points.begin(), more.points.end());
    normals.insert(normals.end(), more.normals.begin(), more.normals.end());
}

CurveSet read_curve(Parameters& p) {
    constexpr Bounds kWidth{0, 1e12};
    CurveSet set;
    set.points = read_segments(p);
    const std::size_t segments = set.points.size() / 3;
    const std::string type = read_word(p, "type", {"flat", "cylinder", "ribbon"});
    const double width = p.number("width", 1, kWidth);
    const double width0 = p.number("width0", width, kWidth), width1 = p.number("width1", width, kWidth);
    set.curves.push_back({static_cast<std::uint32_t>(segments), static_cast<float>(width0), static_cast<float>(width1),
                          type == "ribbon"});
    if (type == "ribbon")
        set.normals = read_ribbon_normals(p, segments);
    else if (p.has("N"))
        p.warn("curve normals", "'N' is ignored: only curves of type 'ribbon' have normals");
    if (type == "flat") p.warn("flat curve", "curves of type 'flat', which turn towards whoever looks, become tubes");
    p.ignore({"splitdepth"});
    return set;
}

} // namespace keyhole::pbrt
