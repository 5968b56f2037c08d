#include "methods/photons/scene_survey.h"

#include "core/shared_work.h"
#include "sampling/paths/image_lattice.h"
#include "sampling/paths/path_tracer.h"

namespace keyhole {
namespace {

constexpr std::int64_t kBlocks = 64;

/// Adds up one path after the other.
struct SurveySink {
    SceneSurvey survey;
    using LooksThroughGlass = std::true_type;
    std::array<double, 5> path{};
    bool saw_surface = false;

    bool arrival(const EyeWalk& walk, const Rgb& /*throughput*/, int /*finite*/) {
        if (walk.size() > 2) return true;
        const Vertex& seen = walk.back();
        const BsdfTraits traits = seen.bsdf.traits();
        const Vec3 back = direction(seen.point, walk[0].point);
        saw_surface = true;
        survey.specular += traits.delta ? 1 : 0;
        survey.glossy += traits.glossy ? seen.bsdf.glossy_probability(back) : 0;
        survey.diffuse += traits.diffuse ? 1 : 0;
        return true;
    }
    void contribution(const EyeWalk& /*walk*/, const Vertex& x0, const Rgb& value, LightClass light) {
        const double y = luminance(value);
        path[static_cast<std::size_t>(light)] += y;
        survey.by_emitter[x0.point.emitter] += y;
    }
    void end() {
        for (std::size_t k = 0; k < path.size(); ++k) survey.light[k].add(path[k]);
        survey.nothing += saw_surface ? 0 : 1;
        ++survey.samples;
        path = {};
        saw_surface = false;
    }
};

} // namespace

double SceneSurvey::total() const {
    double sum = 0;
    for (const RunningStats& l : light) sum += l.mean();
    return sum;
}

SceneSurvey survey_scene(const Scene& scene, std::int64_t samples, int max_scatterings, std::uint64_t seed,
                         const RunContext& context) {
    std::vector<SurveySink> sinks(kBlocks);
    parallel_for(kBlocks, context, [&](std::int64_t b) {
        SurveySink& sink = sinks[static_cast<std::size_t>(b)];
        sink.survey.by_emitter.assign(scene.emitters().size(), 0.0);
        const Range range = split(samples, kBlocks, b);
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            Rng rng(seed, StreamPurpose::survey, static_cast<std::uint64_t>(i));
            trace_path(scene, lattice_image_point(seed, StreamPurpose::survey, i), max_scatterings, rng, sink);
            sink.end();
        }
    });
    SceneSurvey all;
    all.by_emitter.assign(scene.emitters().size(), 0.0);
    for (const SurveySink& sink : sinks) {
        const SceneSurvey& s = sink.survey;
        all.samples += s.samples;
        for (std::size_t k = 0; k < all.light.size(); ++k) all.light[k].merge(s.light[k]);
        for (std::size_t k = 0; k < all.by_emitter.size(); ++k) all.by_emitter[k] += s.by_emitter[k];
        all.specular += s.specular;
        all.glossy += s.glossy;
        all.diffuse += s.diffuse;
        all.nothing += s.nothing;
    }
    const double share = 1 / static_cast<double>(samples);
    for (double& e : all.by_emitter) e *= share;
    for (double* part : {&all.specular, &all.glossy, &all.diffuse, &all.nothing}) *part *= share;
    return all;
}

} // namespace keyhole
