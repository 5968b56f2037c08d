#include "sampling/guided_paths.h"

namespace keyhole {
namespace {

/// Walks go on surely for so many steps, then end at random.
constexpr int kSurely = 2;
constexpr double kGoOn = 0.5;

/// Probability that a walk makes its step `n`, counted from 1.
double step_probability(int n) { return std::pow(kGoOn, std::max(0, n - kSurely)); }
bool goes_on(int steps, Rng& rng) { return steps < kSurely || rng.next() < kGoOn; }

/// As the last vertex that is joined, if it can be.
bool make_joinable(Vertex& v, bool at_end) {
    v.event = Event::finite;
    return at_end || (v.point.site == Site::surface && v.bsdf.traits().finite);
}

} // namespace

GuidedPaths::GuidedPaths(const Scene& scene, const UserPaths& paths, PathSet set, int max_scatterings)
    : scene_(&scene), set_(set), max_scatterings_(max_scatterings), guides_(scene, paths) {}

double GuidedPaths::density(const Path& y) const {
    const int n = y.vertices();
    double density = 0;
    guides_.for_each([&](const GuidedSubPath& guide, double probability) {
        const int first = guide.vertices();
        if (n <= first) return;
        double light = guide.density(y) * probability;
        for (int s = first; s < n && light > 0; ++s) {
            const auto k = static_cast<std::size_t>(s);
            if (joinable(y.x[k - 1], y.x[k])) {
                double product = light * step_probability(s - first) * step_probability(n - s - 1);
                for (std::size_t i = k; i < y.x.size() && product > 0; ++i) product *= y.x[i].pdf_from_eye;
                density += product;
            }
            light *= y.x[k].pdf_from_light;
        }
    });
    return density;
}

void GuidedPaths::sample(const Vec2& image, Rng& rng, const std::function<void(const Path&)>& found) const {
    SubPath light, eye;
    const GuidedSubPath& guide = guides_.choose(rng);
    Failure why{};
    if (!guide.trace(light, rng, why)) return;
    const int most = max_scatterings_ + 2, first = guide.vertices();
    eye.push_back(sample_eye(*scene_, rng));
    for (int steps = 0; first + steps + 2 < most && goes_on(steps, rng); ++steps)
        if (!grow(*scene_, eye, From::eye, image, false, rng, why)) break;
    for (int steps = 0; first + steps + 1 < most && goes_on(steps, rng); ++steps)
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
            const Vec3 to_light = direction(from_eye.back().point, from_light.back().point);
            const auto at = t == 1 ? scene_->camera().image_point(eye[0].point, to_light) : image;
            if (!at) continue;
            const auto path = join(*scene_, set_, from_light, from_eye, *at, why);
            if (path && path->target > 0) found(*path);
            from_eye.back() = eye[t - 1];
        }
        from_light.back() = light[s - 1];
    }
}

} // namespace keyhole
