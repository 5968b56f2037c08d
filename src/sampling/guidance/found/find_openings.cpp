#include "sampling/guidance/found/find_openings.h"

#include "sampling/guidance/found/guidance_gain.h"
#include "sampling/guidance/found/opening_shape.h"
#include "sampling/guidance/user_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace keyhole {
namespace {

/// Emitters of an opening, at most: those whose light comes there most.
constexpr std::size_t kMostEmitters = 4;
/// Bounces on the way, at most.
constexpr int kMostBounces = 20;

UserPathSpec path_through(const FoundOpening& found, const Imath::V3d& lamp, const Imath::V3d& behind, int bounces) {
    UserPathSpec spec;
    spec.points.push_back({lamp});
    for (int i = 0; i < bounces; ++i) spec.points.push_back({.bounce = true});
    spec.points.push_back({.p = behind, .through = found.opening});
    spec.beta.assign(spec.points.size() - 1, kDefaultBeta);
    return spec;
}

/// Light of an emitter that comes through an opening.
struct Source {
    SurfacePoint x0;
    std::ptrdiff_t passages = 0;
    const Passage* straight = nullptr; ///< one that begins on the emitter
};

/// Those of an opening, the most frequent first.
std::vector<Source> sources_of(const FoundOpening& found) {
    std::map<std::uint32_t, Source> by_emitter;
    for (const Passage& p : found.passages) {
        Source& source = by_emitter[p.light.x0.emitter];
        source.x0 = p.light.x0;
        ++source.passages;
        if (p.light.emits && source.straight == nullptr) source.straight = &p;
    }
    std::vector<Source> sources;
    for (const auto& [emitter, source] : by_emitter) sources.push_back(source);
    std::ranges::stable_sort(sources, std::greater(), &Source::passages);
    sources.resize(std::min(sources.size(), kMostEmitters));
    return sources;
}

/// A surface behind the opening that is seen from its middle, away from the light; none where there is none.
std::optional<Imath::V3d> place_behind(const Scene& scene, const FoundOpening& found) {
    SurfacePoint middle;
    middle.p = Vec3(found.opening.centre());
    middle.site = Site::point;
    for (const Passage& p : found.passages) {
        const auto hit = scene.trace(middle, direction(middle, p.eye.point));
        if (hit && hit->site == Site::surface) return Imath::V3d(hit->p);
    }
    return std::nullopt;
}

class Paths {
  public:
    Paths(const Scene& scene, const OpeningSearch& search) : scene_(scene), search_(search) {}

    void add(const FoundOpening& found) {
        ++openings_;
        const auto behind = place_behind(scene_, found);
        for (const Source& source : sources_of(found)) {
            const Imath::V3d lamp(source.x0.p);
            const auto weight = static_cast<double>(source.passages);
            if (source.straight != nullptr)
                add(path_through(found, Imath::V3d(source.straight->light.point.p),
                                 Imath::V3d(source.straight->eye.point.p), 0),
                    weight / 4, source.x0.emitter, 0);
            const int most = std::min(kMostBounces, search_.max_scatterings - 1);
            for (int n = 1; behind && n <= most; ++n)
                add(path_through(found, lamp, *behind, n), weight * (1 - kNextBounce) * std::pow(kNextBounce, n - 1),
                    source.x0.emitter, n);
        }
    }

    int openings() const { return openings_; }

    UserPathFile file;

  private:
    void add(UserPathSpec spec, double weight, std::uint32_t emitter, int bounces) {
        spec.weight = weight;
        spec.name = fmt::format("opening {}, emitter {}", openings_, emitter) +
                    (bounces > 0 ? fmt::format(", {} bounces", bounces) : ", straight");
        if (binds(scene_, spec)) file.paths.push_back(std::move(spec));
    }

    const Scene& scene_;
    const OpeningSearch& search_;
    int openings_ = 0;
};

/// Whether the line of a passage leads through an opening.
bool leads_through(const Passage& passage, const Opening& opening) {
    const Imath::V3d a(passage.light.point.p), b(passage.eye.point.p), n = opening.u.cross(opening.v);
    const double from = (a - opening.corner).dot(n), to = (b - opening.corner).dot(n);
    if (!(from * to < 0)) return false;
    const Imath::V3d offset = a + (b - a) * (from / (from - to)) - opening.corner;
    const double along = offset.cross(opening.v).dot(n) / n.length2(),
                 across = opening.u.cross(offset).dot(n) / n.length2();
    return std::min(along, across) >= 0 && std::max(along, across) <= 1;
}

} // namespace

std::vector<Opening> openings_of(const UserPathFile& file) {
    std::vector<Opening> openings;
    for (const UserPathSpec& path : file.paths)
        for (const UserPathPoint& point : path.points)
            if (point.through) openings.push_back(*point.through);
    return openings;
}

OpeningsFound find_openings(const Scene& scene, const TransportEnds& ends, const OpeningSearch& search,
                            const RunContext& context) {
    std::vector<Passage> passages =
        find_passages(scene, ends, {.pairs = search.pairs, .seconds = search.seconds, .seed = search.seed}, context);
    std::erase_if(passages, [&](const Passage& passage) {
        return std::ranges::any_of(search.known, [&](const Opening& o) { return leads_through(passage, o); });
    });
    Paths paths(scene, search);
    for (std::size_t i = 0; i < search.most; ++i) {
        const auto found = take_opening(scene, passages);
        if (!found) break;
        paths.add(*found);
    }
    OpeningsFound result{std::move(paths.file), paths.openings()};
    if (result.paths.paths.empty()) return {};
    const LightGuides guides(scene, bind_user_paths(scene, result.paths));
    result.gain = gain_by_guides(scene, guides, ends.eye, search.seed, context, search.learned);
    if (!(result.gain >= search.least_gain)) result.paths.paths.clear();
    return result;
}

} // namespace keyhole
