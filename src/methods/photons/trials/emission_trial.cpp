#include "methods/photons/trials/trials.h"

#include "core/shared_work.h"

#include <algorithm>

namespace keyhole {
namespace {

/// Paths, every other one by power.
constexpr std::int64_t kPathsOfTrial = 8192, kPathsOfPart = 128;
/// Density of learned paths over that of those by power, below which they count as missing what these find.
constexpr double kMissed = 0.5;

/// What a light path's photons bring to the picture.
struct VisibleLight {
    const PhotonWeighing& weighing;
    const StorageRule& rule;
    double power = 0, caustic = 0, squares = 0;

    bool arrival(Vertex& v, const Vec3& to_light, const Rgb& arrived, const LightPast& past) {
        if (!v.bsdf.traits().finite) return true;
        const StorageRule::Kinds kinds = rule(v, to_light, past);
        if (kinds.global) add(weighing(PhotonKind::global, v, to_light, arrived), false);
        if (kinds.caustic) add(weighing(PhotonKind::caustic, v, to_light, arrived), true);
        return true;
    }
    void add(const PhotonWeighing::Weight& weight, bool is_caustic) {
        if (!weight.known) return;
        power += weight.value;
        caustic += is_caustic ? weight.value : 0;
        squares += weight.value * weight.value;
    }
};

/// Sums over paths of both kinds, up to a common factor.
struct VisibleSums {
    double plain = 0, learned = 0; ///< second moments
    double power = 0;
    std::vector<double> hidden; ///< see EmissionTrial; not divided by `power`

    /// `ratio`: density of the path as it was learned over that by power; `by_power`: how it was drawn.
    void add(const VisibleLight& light, std::uint32_t emitter, double ratio, bool by_power) {
        if (!(light.power > 0) || !(ratio > 0)) return;
        // What the photons would have by power, and both densities over that by power.
        const double scale = by_power ? 1 : ratio, both = 1 + ratio;
        plain += light.squares * scale * scale / both;
        learned += light.squares * scale * scale / (ratio * both);
        power += light.power * scale / both;
        if (ratio < kMissed) hidden[emitter] += light.caustic * scale / both;
    }
    VisibleSums& operator+=(const VisibleSums& o) {
        plain += o.plain;
        learned += o.learned;
        power += o.power;
        for (std::size_t i = 0; i < hidden.size(); ++i) hidden[i] += o.hidden[i];
        return *this;
    }
};

} // namespace

EmissionTrial try_emission(const Scene& scene, const EmissionGuide& guide, const StorageRule& rule,
                           const LearnedEmission& learned, std::uint64_t seed, const RunContext& context) {
    const PhotonWeighing weighing{guide, 0};
    const VisibleSums none{.hidden = std::vector<double>(scene.emitters().size())};
    const auto trace = [&](Range paths) {
        VisibleSums sums = none;
        for (std::int64_t i = paths.begin; i < paths.end; ++i) {
            Rng rng(seed, StreamPurpose::emission_trial, static_cast<std::uint64_t>(i));
            const bool by_power = i % 2 == 0;
            const auto light = by_power ? emit_light(scene, rng) : learned.sample(rng);
            if (!light) continue;
            VisibleLight visible{weighing, rule};
            trace_light_path(scene, *light, rule.max_scatterings, rng, visible);
            const double ratio = learned.density_ratio(light->x0, light->ray.w, light->ray.origin.p);
            sums.add(visible, light->x0.emitter, ratio, by_power);
        }
        return sums;
    };
    const std::vector<VisibleSums> parts = make_blocks({0, kPathsOfTrial}, kPathsOfPart, context, trace);
    // Without the part that found most: one path in thousands may have all of a second moment.
    const auto most = std::ranges::max_element(parts, {}, &VisibleSums::learned);
    VisibleSums all = none;
    for (auto part = parts.begin(); part != parts.end(); ++part)
        if (part != most) all += *part;
    if (!(all.plain > 0)) return {1, all.hidden};
    for (double& h : all.hidden) h /= all.power;
    return {all.learned / all.plain, std::move(all.hidden)};
}

} // namespace keyhole
