#include "methods/inspection/inspection.h"

#include "methods/learned_direct_light_scope.h"
#include "methods/method.h"
#include "photonmap/importance/importance_tracing.h"

#include <fmt/format.h>

#include <algorithm>

namespace keyhole {
namespace {

/// Keeps what the first pass is made from.
class PassRecorder final : public PassObserver {
  public:
    /// @param learned may be null
    PassRecorder(const InspectionLimits& limits, std::uint64_t seed, const LearnedDirectLight* learned, Inspection& out)
        : limits_(limits), seed_(seed), learned_(learned), out_(out) {}

    void stored(const Photon& photon, const PhotonOrigin& origin) override {
        if (!done_) recorder_.stored(photon, origin);
    }
    void thrown_away(const Vec3& p) override {
        if (!done_) recorder_.thrown_away(p);
    }
    void sampled(const Photons& photons) override {
        if (!done_) out_.photons = recorder_.sample(photons, limits_.photons, limits_.trails);
    }
    void ready(const PassGather& gather) override {
        if (std::exchange(done_, true)) return;
        const double pixels = gather.rays().scene().camera().window().size();
        const auto rays = static_cast<int>(std::clamp(static_cast<double>(limits_.gather_rays) / pixels, 1.0, 16.0));
        out_.pixels =
            pixel_lights(gather.rays(), gather.irradiance(), {.gather = rays, .seed = seed_, .learned = learned_});
        keep_coverage(gather.coverage());
        if (gather.cache() != nullptr) keep_records(*gather.cache());
    }

  private:
    void keep_coverage(const GatherCoverage* coverage) {
        out_.gathered_everywhere = coverage == nullptr;
        if (coverage == nullptr) return;
        for (PhotonShown& p : out_.photons.photons)
            p.gathered = coverage->comes_to(p.photon.position(), p.photon.normal().decode());
    }
    void keep_records(const IrradianceCache& cache) {
        out_.record_count = cache.size();
        const std::vector<double> noise = cache.relative_noise();
        const std::size_t shown = std::min(limits_.records, cache.size());
        for (std::size_t k = 0; k < shown; ++k) {
            const std::size_t i = k * cache.size() / shown;
            const auto answer = cache.irradiance(cache.position(i), cache.normal(i));
            out_.records.push_back({cache.position(i), cache.normal(i), cache.radius(i), static_cast<float>(noise[i]),
                                    static_cast<float>(luminance(answer.irradiance))});
        }
    }

    InspectionLimits limits_;
    std::uint64_t seed_;
    const LearnedDirectLight* learned_;
    Inspection& out_;
    PhotonRecorder recorder_;
    bool done_ = false; // the first pass
};

void keep_importons(const Scene& scene, const Settings& settings, const InspectionLimits& limits,
                    const RunContext& context, Inspection& out) {
    const Importons found = trace_importance(scene,
                                             {.samples = static_cast<std::int64_t>(limits.importons),
                                              .max_scatterings = static_cast<int>(settings.max_depth),
                                              .seed = settings.seed},
                                             context);
    out.importon_count = found.first.size() + found.second.size();
    const auto add = [&](const std::vector<Photon>& importons, bool first) {
        const std::size_t shown = std::min(limits.importons / 2, importons.size());
        for (std::size_t k = 0; k < shown; ++k) {
            const Photon& p = importons[k * importons.size() / shown];
            out.importons.push_back({p.position(), static_cast<float>(luminance(p.power())), first});
        }
    };
    add(found.first, true);
    add(found.second, false);
}

} // namespace

Inspection inspect_scene(Scene& scene, const Settings& settings, const UserPaths& paths, const InspectionLimits& limits,
                         const RunContext& context) {
    if (!settings.method->keeps_photons)
        throw InputError(fmt::format("found method {}, expected one that keeps photons: {}", settings.method->name,
                                     names_of(&Method::keeps_photons)));
    set_window_margin(scene, settings);
    Inspection out;
    Findings findings;
    const LearnedDirectLightScope direct_light(scene, settings, context);
    out.learned_direct_light = direct_light.learned() != nullptr;
    PassRecorder recorder(limits, settings.seed, direct_light.learned(), out);
    out.render = render_by_method({scene, settings, paths, context, {}, findings, &recorder});
    out.render.settings = settings;
    Settings other = settings;
    ++other.seed;
    other.save_map.clear();
    out.again = render_by_method({scene, other, paths, context, {}, findings});
    keep_importons(scene, settings, limits, context, out);
    out.surface = surface_mesh(scene, limits.triangles);
    return out;
}

} // namespace keyhole
