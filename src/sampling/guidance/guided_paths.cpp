#include "sampling/guidance/guided_paths.h"

#include "core/integer_power.h"

namespace keyhole {
namespace {

/// Pairs of sub-paths in a sample. What the other technique finds where this one seldom goes is most of the variance.
constexpr int kPairs = 3;

/// Probability that a walk makes one step more, beside that of not being absorbed.
constexpr double kGoOn = 0.7;

bool goes_on(Rng& rng) { return rng.next() < kGoOn; }
int draw_steps(Rng& rng) {
    int steps = 0;
    while (goes_on(rng)) ++steps;
    return steps;
}

/// As the last vertex that is joined, if it can be.
bool make_joinable(Vertex& v, bool at_end) {
    v.event = Event::finite;
    return at_end || (v.point.site == Site::surface && v.bsdf.traits().finite);
}

} // namespace

GuidedPaths::GuidedPaths(const Scene& scene, const UserPaths& paths, PathSet set, int max_scatterings)
    : scene_(&scene), set_(set), max_scatterings_(max_scatterings), guides_(scene, paths) {}

double GuidedPaths::expected_connections(const Path& y) const {
    const int n = y.vertices();
    double expected = 0;
    guides_.for_each([&](const GuidedSubPath& guide, double chosen) {
        const int first = guide.vertices();
        if (n <= first) return;
        double light = guide.density(y) * chosen;
        if (light > 0) light *= integer_power(kGoOn, n - first - 1); // of both walks together
        for (int s = first; s < n && light > 0; ++s) {
            if (joinable(y.x[s - 1], y.x[s])) {
                double product = light;
                for (int i = s; i < y.vertices() && product > 0; ++i) product *= y.x[i].pdf_from_eye;
                expected += product;
            }
            light *= y.x[s].pdf_from_light;
        }
    });
    return expected;
}

double GuidedPaths::density(const Path& y) const { return kPairs * expected_connections(y); }

double GuidedPaths::draw_density(const Path& y) const { return (1 - kGoOn) * (1 - kGoOn) * expected_connections(y); }

std::optional<Path> GuidedPaths::draw(Rng& rng, Failure& why) const {
    const GuidedSubPath& guide = guides_.choose(rng);
    const int from_light = draw_steps(rng), from_eye = draw_steps(rng);
    if (guide.vertices() + from_light + from_eye + 1 > max_scatterings_ + 2) return why = Failure::length, std::nullopt;
    SubPath light, eye;
    if (!guide.trace(light, rng, why)) return std::nullopt;
    for (int i = 0; i < from_light; ++i)
        if (!grow(*scene_, light, From::light, Vec2(0, 0), false, rng, why)) return std::nullopt;
    const auto u = static_cast<float>(rng.next()), v = static_cast<float>(rng.next());
    eye.push_back(sample_eye(*scene_, rng));
    for (int i = 0; i < from_eye; ++i)
        if (!grow(*scene_, eye, From::eye, Vec2(u, v), false, rng, why)) return std::nullopt;
    if (!make_joinable(light.back(), false) || !make_joinable(eye.back(), from_eye == 0))
        return why = Failure::signature, std::nullopt;
    return join(*scene_, set_, light, eye, Vec2(u, v), why);
}

void GuidedPaths::sample(const Vec2& image, Rng& rng, const std::function<void(const Path&)>& found) const {
    for (int pair = 0; pair < kPairs; ++pair) sample_pair(image, rng, found);
}

void GuidedPaths::sample_pair(const Vec2& image, Rng& rng, const std::function<void(const Path&)>& found) const {
    SubPath light, eye;
    const GuidedSubPath& guide = guides_.choose(rng);
    Failure why{};
    if (!guide.trace(light, rng, why)) return;
    const int most = max_scatterings_ + 2, first = guide.vertices();
    eye.push_back(sample_eye(*scene_, rng));
    for (int steps = 0; first + steps + 1 < most && goes_on(rng); ++steps)
        if (!grow(*scene_, eye, From::eye, image, false, rng, why)) break;
    for (int steps = 0; first + steps + 1 < most && goes_on(rng); ++steps)
        if (!grow(*scene_, light, From::light, image, false, rng, why)) break;

    SubPath from_light, from_eye;
    for (std::size_t s = 1; s <= light.size(); ++s) {
        from_light.push_back(light[s - 1]);
        if (static_cast<int>(s) < first || !make_joinable(from_light.back(), false)) continue;
        from_eye.clear();
        for (std::size_t t = 1; t <= eye.size() && static_cast<int>(s + t) <= most; ++t) {
            from_eye.push_back(eye[t - 1]);
            if (!make_joinable(from_eye.back(), t == 1)) {
                from_eye.back() = eye[t - 1];
                continue;
            }
            const auto path = join(*scene_, set_, from_light, from_eye, image, why);
            if (path && path->target > 0) found(*path);
            from_eye.back() = eye[t - 1];
        }
        from_light.back() = light[s - 1];
    }
}

} // namespace keyhole
