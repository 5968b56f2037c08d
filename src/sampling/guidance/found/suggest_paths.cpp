#include "sampling/guidance/found/suggest_paths.h"

#include "core/parallel.h"
#include "sampling/guidance/user_paths.h"
#include "sampling/proposals/edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace keyhole {
namespace {

/// The light sub-path that a user path could make of a path.
struct Candidate {
    Path path;
    int vertices = 0; ///< from the light on
    double weight = 0;
};

/// Up to the vertex before d1, which a proposal joins to d1; up to d1 itself where light comes to it by way of
/// specular vertices. 0: there is none.
int light_vertices(const Path& path) {
    const int d1 = nth_finite_from_eye(path, 1);
    if (d1 == 0) return 0;
    const int n = path.x[d1 - 1].specular() ? d1 + 1 : d1;
    return n >= 2 ? n : 0;
}

/// Contribution over the density of a wholly new path, summed over all ways of making it from both ends.
double hardness(const Path& path) {
    const double density = bidirectional_density(path);
    return density > 0 ? path.target / density : 0;
}

std::vector<Candidate> candidates(const Scene& scene, const std::vector<Path>& pool) {
    std::vector<Candidate> found;
    for (const Path& path : pool) {
        const int n = light_vertices(path);
        if (n == 0 || scene.emitter(path.x[0].point.emitter).site() == Site::infinite) continue;
        if (const double weight = hardness(path); weight > 0) found.push_back({path, n, weight});
    }
    return found;
}

bool alike(const Candidate& a, const Candidate& b, double radius) {
    if (a.vertices != b.vertices) return false;
    for (int i = 0; i < a.vertices; ++i) {
        if (a.path.x[i].event != b.path.x[i].event && i + 1 < a.vertices) return false;
        if ((a.path.x[i].point.p - b.path.x[i].point.p).length() > radius) return false;
    }
    return true;
}

/// The root mean square angle at which the paths of a cluster leave their vertex i, about the point after it of the
/// one in the middle; doubled and within bounds.
double cone_of(const Candidate& middle, const std::vector<const Candidate*>& cluster, int i) {
    constexpr double least = 3 * kPi / 180, most = 30 * kPi / 180;
    if (cluster.size() < 3) return std::clamp(kDefaultBeta, least, most);
    double sum = 0, weights = 0;
    for (const Candidate* c : cluster) {
        const Vec3& from = c->path.x[i].point.p;
        const Vec3 axis = (middle.path.x[i + 1].point.p - from).normalized();
        const double chord = (leaving_direction(c->path, i, +1) - axis).length();
        sum += c->weight * chord * chord;
        weights += c->weight;
    }
    return std::clamp(2 * std::sqrt(sum / weights), least, most);
}

UserPathSpec spec_of(const Candidate& middle, const std::vector<const Candidate*>& cluster) {
    UserPathSpec spec;
    spec.weight = 0;
    for (const Candidate* c : cluster) spec.weight += c->weight;
    const auto short_of = [](float x) { return std::stod(fmt::format("{}", x)); }; // the same float, in few digits
    for (int i = 0; i < middle.vertices; ++i) {
        const Vec3& p = middle.path.x[i].point.p;
        spec.points.push_back({{short_of(p.x), short_of(p.y), short_of(p.z)}});
    }
    for (int i = 0; i + 1 < middle.vertices; ++i) spec.beta.push_back(cone_of(middle, cluster, i));
    return spec;
}

/// Names, and weights with a mean of about 1.
void finish(UserPathFile& file) {
    double total = 0;
    for (const UserPathSpec& path : file.paths) total += path.weight;
    for (std::size_t i = 0; i < file.paths.size(); ++i) {
        file.paths[i].name = fmt::format("suggested {}", i + 1);
        const double weight = file.paths[i].weight * static_cast<double>(file.paths.size()) / total;
        file.paths[i].weight = std::clamp(weight, 0.1, 10.0);
    }
}

} // namespace

UserPathFile suggest_user_paths(const Scene& scene, const StageOneSettings& first, const SuggestOptions& options) {
    const StageOne one = run_stage_one(scene, first, {});
    const std::vector<Candidate> all =
        candidates(scene, choose_seeds(scene, first, one, one.all_groups(), options.pool));
    const double radius = options.radius * (scene.upper() - scene.lower()).length();
    const double gone = -std::numeric_limits<double>::infinity();
    std::vector<double> score(all.size(), 0.0); // weight of those that are left and alike
    std::vector<const Candidate*> some;
    const auto count = [&](double sign) {
        parallel_for(static_cast<std::int64_t>(all.size()), [&](std::int64_t i) {
            const auto k = static_cast<std::size_t>(i);
            for (const Candidate* c : some)
                if (alike(all[k], *c, radius)) score[k] += sign * c->weight;
        });
    };
    for (const Candidate& c : all) some.push_back(&c);
    count(1);
    UserPathFile file;
    while (file.paths.size() < options.count) {
        const auto best = std::ranges::max_element(score);
        if (best == score.end() || *best == gone) break;
        const Candidate& middle = all[static_cast<std::size_t>(best - score.begin())];
        some.clear();
        for (std::size_t i = 0; i < all.size(); ++i)
            if (score[i] != gone && alike(middle, all[i], radius)) some.push_back(&all[i]);
        if (UserPathSpec spec = spec_of(middle, some); binds(scene, spec))
            file.paths.push_back(std::move(spec));
        else
            some = {&middle};
        count(-1);
        for (const Candidate* c : some) score[static_cast<std::size_t>(c - all.data())] = gone;
    }
    if (!file.paths.empty()) finish(file);
    return file;
}

} // namespace keyhole
