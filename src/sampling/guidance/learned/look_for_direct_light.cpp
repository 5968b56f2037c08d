#include "sampling/guidance/learned/look_for_direct_light.h"

#include "core/shared_work.h"
#include "sampling/paths/clear_glass.h"
#include "sampling/paths/direct_light.h"
#include "sampling/paths/image_lattice.h"
#include "sampling/paths/random_walk.h"

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

/// Paths of the first round.
constexpr std::int64_t kFirstPaths = 2048;
/// Vertices with a finite part that are asked along a path from the eye: the one seen, the end of a gather ray, and the
/// next; and shadow rays from each.
constexpr int kVertices = 3, kShadowRays = 2;
/// Learning ends early where so much was found and second moments would stay above this share of the light tree's.
constexpr std::size_t kEnoughFound = 4096;
constexpr double kNoGain = 0.85;
/// No more is looked for where so much was found.
constexpr std::size_t kMostFound = std::size_t{1} << 19;

/// What a round of paths has found, by how many samples.
struct Round {
    std::vector<FoundLight> found;
    std::int64_t samples = 0;
};

/// Asks for light along a walk from the eye.
struct LightQuestions : WalkHooks {
    const Scene& scene;
    const LearnedDirectLight* sampler; // null: the light tree
    Rng& rng;
    Round& round;
    int finite = 0;
    int scatterings = 0;
    LastTwoVertices vertices{};

    Vertex& place() { return vertices.place(); }
    bool arrive(const Vertex& v, const WalkRay& ray) {
        if (v.point.site == Site::infinite) return false;
        ++scatterings;
        if (!v.bsdf.traits().finite) return true;
        for (int i = 0; i < kShadowRays; ++i) ask(v, -ray.w);
        return ++finite < kVertices;
    }
    bool survives(Rgb& throughput, SampleSource& numbers) const {
        return play_roulette(eye_survival(throughput, scatterings), throughput, numbers);
    }

  private:
    void ask(const Vertex& v, const Vec3& back) const {
        ++round.samples;
        const auto [x0, pdf] =
            sampler != nullptr ? sampler->sample(v.point, rng) : sample_by_light_tree(scene, v.point, rng);
        if (!(pdf > 0)) return;
        const Vec3 w = direction(v.point, x0);
        if (is_black(scatter(v.point, v.bsdf, Event::finite, w, back).value)) return;
        const Emitter& emitter = scene.emitter(x0.emitter);
        double value = luminance(emitter.radiance(x0, -w)) * geometry_term(v.point, x0, w);
        if (!(value > 0) || !std::isfinite(value)) return;
        value *= luminance(straight_transmittance(scene, v.point, x0));
        if (!(value > 0)) return;
        round.found.push_back({.at = {v.point.p, v.point.ng},
                               .emitter = x0.emitter,
                               .infinite = is_environment(emitter),
                               .towards = w,
                               .value = value,
                               .choice = scene.light_tree().probability(v.point, x0.emitter),
                               .point_pdf = emitter.point_pdf(x0)});
    }
};

Round look(const Scene& scene, const LearnedDirectLight* sampler, const DirectLightLearning& learning, Range paths,
           const RunContext& context) {
    constexpr std::int64_t kBlock = 64;
    const auto look_along = [&](Range block) {
        Round found;
        for (std::int64_t i = block.begin; i < block.end; ++i) {
            Rng rng(learning.seed, StreamPurpose::learned_direct_light, static_cast<std::uint64_t>(i));
            LightQuestions questions{{}, scene, sampler, rng, found};
            const Vertex eye = sample_eye(scene, rng);
            const Vec2 image = lattice_image_point(learning.seed, StreamPurpose::learned_direct_light, i);
            random_walk(scene, From::eye, eye_ray(scene, eye.point, image), learning.max_scatterings, rng, questions);
        }
        context.advance(block.size());
        return found;
    };
    Round all;
    for (const Round& part : make_blocks(paths, kBlock, context, look_along)) {
        all.found.insert(all.found.end(), part.found.begin(), part.found.end());
        all.samples += part.samples;
    }
    return all;
}

/// The samplers of all rounds so far, and what they found.
struct Memory {
    struct Sampler {
        std::shared_ptr<const LearnedDirectLight> sampler; // null: the light tree
        double samples;
        double density(const FoundLight& f) const {
            return samples * (sampler != nullptr ? sampler->pdf(f) : f.choice * f.point_pdf);
        }
    };
    std::vector<Sampler> samplers;
    std::vector<FoundLight> found;

    /// Adds a round: all samples count by the balance heuristic (Veach 1997, eq. 9.8).
    void add(Round round, std::shared_ptr<const LearnedDirectLight> sampler) {
        samplers.push_back({std::move(sampler), static_cast<double>(round.samples)});
        for (FoundLight& f : found) f.density += samplers.back().density(f);
        for (FoundLight& f : round.found)
            for (const Sampler& s : samplers) f.density += s.density(f);
        found.insert(found.end(), round.found.begin(), round.found.end());
    }
};

/// Time that has been used, by the clock that the stop goes by [s]; 0 where there is none.
class Spent {
  public:
    explicit Spent(const RunContext& context) : context_(context), start_(context.seconds_left()) {}
    double seconds() const { return std::isfinite(start_) ? start_ - context_.seconds_left() : 0; }

  private:
    const RunContext& context_;
    double start_;
};

/// From as much of what was found as the memory allows [bytes].
std::shared_ptr<const LearnedDirectLight> learn_within(const Scene& scene, std::span<const FoundLight> found,
                                                       std::size_t most) {
    auto learned = std::make_shared<const LearnedDirectLight>(scene, found);
    while (learned->bytes() > most && !found.empty()) {
        found = found.first(found.size() / 2);
        learned = std::make_shared<const LearnedDirectLight>(scene, found);
    }
    return learned;
}

} // namespace

bool has_choice_of_direct_light(const Scene& scene) {
    return scene.emitters().size() > 2 ||
           std::ranges::any_of(scene.emitters(), [](const auto& e) { return is_environment(*e); });
}

std::shared_ptr<const LearnedDirectLight> learn_direct_light(const Scene& scene, const DirectLightLearning& learning,
                                                             const RunContext& context) {
    if (!has_choice_of_direct_light(scene) || learning.paths <= 0) return nullptr;
    const Spent spent(context);
    const ProgressStage progress(context, "direct light", learning.paths, "paths");
    Memory memory;
    std::shared_ptr<const LearnedDirectLight> learned;
    for (std::int64_t done = 0, paths = std::min(kFirstPaths, learning.paths); paths > 0;) {
        const double before = spent.seconds();
        memory.add(look(scene, learned.get(), learning, {done, done + paths}, context), learned);
        if (!memory.found.empty()) learned = learn_within(scene, memory.found, learning.most_bytes);
        if (memory.found.size() > kEnoughFound && learned->second_moment_ratio() > kNoGain) break;
        if (memory.found.size() > kMostFound || (learned && learned->bytes() > learning.most_bytes / 2)) break;
        done += paths;
        const std::int64_t least = paths / 2;
        const double now = spent.seconds(), for_paths = (learning.seconds - now) / std::max(now - before, 1e-6);
        paths = std::min(static_cast<std::int64_t>(std::min(2.0, for_paths) * static_cast<double>(paths)),
                         learning.paths - done);
        if (paths < std::min(least, learning.paths - done)) break;
    }
    return learned && learned->second_moment_ratio() <= kNoGain ? learned : nullptr;
}

} // namespace keyhole
