#include "sampling/guidance/learned/learned_emission.h"

#include <algorithm>
#include <numeric>

namespace keyhole {

namespace {

/// Of all first edges, those that aim at no target.
constexpr double kPlain = 0.2, kPlainWhereHidden = 0.5;
/// Of these, those whose emitter is chosen by power: one whose light is hard to find from the eye is seldom seen, and
/// may matter all the same.
constexpr double kPlainEmitters = 0.5;
/// So many lamps are seldom all worth the same.
constexpr std::size_t kManyEmitters = 12;
/// A path counts as so many times the mean at most: what was hard to find must not draw all light to where it was.
constexpr double kMostWeight = 20;

} // namespace

bool LearnedEmission::can_learn(const Scene& scene) {
    return scene.emitters().size() >= kManyEmitters ||
           std::ranges::any_of(scene.emitters(), [](const auto& e) { return e->site() == Site::infinite; });
}

LearnedEmission::LearnedEmission(const Scene& scene, std::vector<SeenLight> seen) : scene_(&scene) {
    choose_emitters(seen);
    targets_ = EmissionTargets(scene, seen);
    if (!targets_.empty()) plain_ = kPlain;
}

void LearnedEmission::choose_emitters(std::vector<SeenLight>& seen) {
    std::vector<double> shares(scene_->emitters().size());
    for (std::size_t i = 0; i < shares.size(); ++i)
        shares[i] = scene_->emitter_distribution().probability(static_cast<std::uint32_t>(i));
    double sum = 0, limited = 0;
    for (const SeenLight& s : seen) sum += s.weight;
    if (sum > 0) {
        const double most = kMostWeight * sum / static_cast<double>(seen.size());
        for (SeenLight& s : seen) limited += s.weight = std::min(s.weight, most);
        for (double& share : shares) share *= kPlainEmitters;
        for (const SeenLight& s : seen) shares[s.emitter] += (1 - kPlainEmitters) * s.weight / limited;
    }
    choice_ = EmitterDistribution(shares);
}

void LearnedEmission::add_hidden(std::span<const double> hidden) {
    const double sum = std::accumulate(hidden.begin(), hidden.end(), 0.0);
    std::vector<double> shares(hidden.size());
    for (std::size_t i = 0; i < shares.size(); ++i)
        shares[i] = 0.5 * choice_.probability(static_cast<std::uint32_t>(i)) + 0.5 * hidden[i] / sum;
    choice_ = EmitterDistribution(shares);
    plain_ = std::max(plain_, kPlainWhereHidden);
}

FirstEdge LearnedEmission::sample_plain(double u, SampleSource& source) const {
    const std::uint32_t i = choice_.sample(u);
    SurfacePoint x0 = scene_->emitter(i).sample_point(source).point;
    x0.emitter = i;
    return {x0, scene_->emitter(i).sample_ray(x0, source)};
}

std::optional<EmittedLight> LearnedEmission::sample(SampleSource& source) const {
    if (choice_.empty()) return std::nullopt;
    const double u = source.next();
    FirstEdge edge =
        u < plain_ ? sample_plain(u / plain_, source) : targets_.sample((u - plain_) / (1 - plain_), source);
    edge.ray.pdf = pdf(edge);
    return emit_along(*scene_, edge.x0, 1, edge.ray);
}

double LearnedEmission::pdf(const FirstEdge& edge) const {
    const Emitter& emitter = scene_->emitter(edge.x0.emitter);
    double sum = plain_ * choice_.probability(edge.x0.emitter) * emitter.point_pdf(edge.x0) *
                 emitter.ray_pdf(edge.x0, edge.ray.w);
    if (plain_ < 1) sum += (1 - plain_) * targets_.pdf(edge);
    return sum;
}

double LearnedEmission::density_ratio(const SurfacePoint& x0, const Vec3& w, const Vec3& p) const {
    const Emitter& emitter = scene_->emitter(x0.emitter);
    const double by_power =
        scene_->emitter_distribution().probability(x0.emitter) * emitter.point_pdf(x0) * emitter.ray_pdf(x0, w);
    if (!(by_power > 0)) return 0;
    EmitterRay ray;
    if (x0.site == Site::infinite) {
        ray = parallel_ray(*scene_, x0, p);
    } else {
        ray.origin = x0;
        ray.w = w;
    }
    return pdf({x0, ray}) / by_power;
}

double LearnedEmission::effective_emitters() const {
    double squares = 0;
    for (std::uint32_t i = 0; i < scene_->emitters().size() && !choice_.empty(); ++i)
        squares += choice_.probability(i) * choice_.probability(i);
    return squares > 0 ? 1 / squares : 0;
}

} // namespace keyhole
