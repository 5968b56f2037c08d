#include "sampling/proposals/tuning.h"

#include "core/parallel.h"
#include "sampling/markov/acceptance.h"
#include "scene/ray_counter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace keyhole {
namespace {

constexpr std::int64_t kLeastCandidates = 64; ///< of a kind
constexpr std::int64_t kMostCandidates = 1 << 15;
/// How much weight what is measured has, beside the settings: jumps say nothing of small features, such as caustics,
/// that some kinds are there for.
constexpr double kMeasured = 0.5;

/// Work besides rays, in rays: candidates that fail at once cost, too.
constexpr double kOverhead = 1;

/// Squared distances between two paths, in units of no meaning: what is asked is which kind goes furthest.
struct Jump {
    double image = 0; ///< in the image
    double light = 0; ///< of the vertices that light meets first
    double both = 0;  ///< product of the two: of moves that leave nothing where it was

    Jump& operator+=(const Jump& o) {
        image += o.image;
        light += o.light;
        both += o.both;
        return *this;
    }
    Jump operator*(double factor) const { return {image * factor, light * factor, both * factor}; }
};

Jump jump(const Path& x, const Path& y) {
    const Vec2 step = y.image - x.image;
    const double image = step.dot(step), light = (y.x[1].point.p - x.x[1].point.p).length2();
    return {image, light, image * light};
}

/// Expected jump of a candidate of kind k at x.
Jump expected_jump(const Mixture<Path>& mixture, std::size_t k, const Path& x, Rng& rng) {
    if (!(mixture.kind(k).suitability(x) > 0)) return {};
    Failure why{};
    const auto y = mixture.kind(k).propose(x, rng, why);
    if (!y || y->target == 0) return {};
    return jump(x, *y) * acceptance(mixture.acceptance_ratio(x, *y, k));
}

/// Expected jump of a kind over the rays that it takes, from `count` candidates.
Jump efficiency(const Mixture<Path>& mixture, std::size_t k, std::span<const Path> paths, std::int64_t count,
                std::uint64_t seed) {
    std::vector<Jump> jumps(static_cast<std::size_t>(count));
    const std::uint64_t rays = rays_traced();
    parallel_for(count, [&](std::int64_t i) {
        Rng rng(seed, StreamPurpose::proposal_tuning,
                (static_cast<std::uint64_t>(k) << 32) + static_cast<std::uint64_t>(i));
        const auto path = static_cast<std::size_t>(i * static_cast<std::int64_t>(paths.size()) / count);
        jumps[static_cast<std::size_t>(i)] = expected_jump(mixture, k, paths[path], rng);
    });
    const double work = static_cast<double>(rays_traced() - rays) + kOverhead * static_cast<double>(count);
    return std::accumulate(jumps.begin(), jumps.end(), Jump{}, [](Jump sum, const Jump& j) { return sum += j; }) *
           (1 / work);
}

} // namespace

Settings tuned_proposals(const ProposalContext& context, const Settings& settings, std::span<const Path> paths,
                         std::uint64_t seed) {
    if (!settings.tune_proposals || paths.empty()) return settings;
    std::vector<const ProposalKind*> of_proposal;
    const Mixture<Path> mixture = make_mixture(context, settings, &of_proposal);
    // Proposals of one kind, one for each user path, share its weight, and what it may take.
    struct Tally {
        const ProposalKind* kind;
        Jump efficiency{};
        double proposals = 0;
    };
    std::vector<Tally> tallies;
    for (const ProposalKind* kind : of_proposal) {
        if (tallies.empty() || tallies.back().kind != kind) tallies.push_back({kind});
        tallies.back().proposals += 1;
    }
    const std::int64_t candidates = std::min<std::int64_t>(settings.mutations / 16, kMostCandidates);
    if (candidates < kLeastCandidates * static_cast<std::int64_t>(tallies.size())) return settings;

    std::size_t k = 0;
    for (Tally& tally : tallies) {
        const std::int64_t each =
            candidates / static_cast<std::int64_t>(tallies.size() * static_cast<std::size_t>(tally.proposals));
        for (double left = tally.proposals; left > 0; --left, ++k)
            tally.efficiency +=
                efficiency(mixture, k, paths, std::max<std::int64_t>(each, 1), seed) * (1 / tally.proposals);
    }
    Jump total;
    for (const Tally& tally : tallies) total += tally.efficiency;
    if (!(total.both > 0)) return settings;
    double given = 0;
    for (const Tally& t : tallies) given += settings.proposals[t.kind->weight];
    Settings tuned = settings;
    for (const Tally& t : tallies) {
        const Jump& own = t.efficiency;
        const double shares = own.image / total.image + own.light / total.light + own.both / total.both;
        tuned.proposals[t.kind->weight] = std::lerp(settings.proposals[t.kind->weight] / given, shares / 3, kMeasured);
    }
    return tuned;
}

} // namespace keyhole
