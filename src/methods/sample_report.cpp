#include "methods/sample_report.h"

#include "core/rng.h"
#include "methods/enclosure.h"
#include "methods/lit_specular.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace keyhole {
namespace {

/// Of the mean over the picture; pixels are worse.
constexpr double kMostSampleError = 0.05;

/// Samples that have to meet an emitter before their variance tells how well it is known.
constexpr double kFewHits = 16;

/// An emitter as the picture shows it.
struct Image {
    double share;     ///< of the window that it covers, at most
    double luminance; ///< what it adds to the mean of the picture, at most [W/(m^2 sr)]
};

/// The sun is 0.27 degrees wide to either side: 15000 of 1/sr.
constexpr double kSunDensity = 200;

/// Whether most of an emitter's light comes from a small part of the sky.
bool is_sun(const Emitter& emitter) {
    if (emitter.site() != Site::infinite || !(emitter.power() > 0)) return false;
    if (emitter.is_delta()) return true;
    constexpr int kPoints = 16;
    Rng rng(0, StreamPurpose::path_tracing, 0);
    int narrow = 0;
    for (int i = 0; i < kPoints; ++i) narrow += emitter.sample_point(rng).pdf > kSunDensity ? 1 : 0;
    return 2 * narrow >= kPoints;
}

std::optional<Image> image_of(const Scene& scene, const Emitter& emitter) {
    const auto bounds = emitter.bounds();
    if (!bounds || emitter.is_delta()) return std::nullopt;
    Rng rng(0, StreamPurpose::path_tracing, 0);
    const SurfacePoint eye = scene.camera().eye(0.5, 0.5);
    SurfacePoint point = emitter.sample_point(rng).point;
    const auto is_seen = [&] {
        const Vec3 to = direction(eye, point);
        return scene.camera().image_point(eye, to) && luminance(emitter.radiance(point, -to)) > 0 &&
               scene.visible(eye, point);
    };
    // Half of a closed emitter's points lie on its far side.
    for (int i = 1; i < 16 && !is_seen(); ++i) point = emitter.sample_point(rng).point;
    if (!is_seen()) return std::nullopt;
    const Vec3 w = direction(eye, point);
    const double distance2 = (point.p - eye.p).length2(), radius2 = (bounds->upper - bounds->lower).length2() / 4.0;
    const double pdf = scene.camera().direction_pdf(w);
    return Image{kPi * radius2 / distance2 * pdf, bounds->intensity / distance2 * pdf};
}

void report_small_emitters(const RunningStats& luminance, const Scene& scene, RenderStats& stats) {
    if (luminance.count() == 0) return; // nothing was looked at
    double missed = 0;
    for (const auto& emitter : scene.emitters()) {
        const auto image = image_of(scene, *emitter);
        if (image && image->share * static_cast<double>(luminance.count()) < kFewHits) missed += image->luminance;
    }
    if (missed > kMostSampleError * luminance.mean())
        stats.warn(Doubt::direct_light,
                   fmt::format("emitters that the eye sees are so small that hardly a sample meets them, "
                               "and may be {:.0f} % of the picture's light: try more spp, or bdpt",
                               100 * missed / (missed + luminance.mean())));
}

/// Returns whether no more samples would help.
bool report_enclosure(const Scene& scene, RenderStats& stats) {
    const Shape* wall = dark_enclosure(scene);
    if (wall == nullptr) return false;
    stats.warn(Doubt::scene, fmt::format("the camera stands within a closed shape{}, which no light goes through, and "
                                         "nothing in there emits: the picture is black. Move the camera or the shape",
                                         wall->name.empty() ? "" : " '" + wall->name + "'"));
    return true;
}

} // namespace

void report_samples(const RunningStats& luminance, const Scene& scene, RenderStats& stats) {
    if (!(luminance.mean() > 0)) return;
    const double error = luminance.standard_error() / luminance.mean();
    stats.values["relative error of the mean"] = error;
    if ((luminance.count() < 2 || error > kMostSampleError) && !report_enclosure(scene, stats))
        stats.warn(Doubt::samples,
                   fmt::format("samples of pixels are so few or unequal that the mean of the picture is "
                               "known to {:.0f} % only (standard error): try more spp",
                               100 * error));
}

void report_eye_samples(const RunningStats& luminance, const Scene& scene, RenderStats& stats) {
    report_samples(luminance, scene, stats);
    report_small_emitters(luminance, scene, stats);
}

void report_black(const RunningStats& luminance, const Scene& scene, RenderStats& stats, bool photons) {
    if (luminance.count() > 0 && !(luminance.mean() > 0) && !report_enclosure(scene, stats))
        stats.warn(
            Doubt::samples,
            scene.emitters().empty()
                ? "the picture is black: nothing in the scene emits light"
                : fmt::format("no sample carried light: the picture is black. If light reaches what is seen, {}. "
                              "Surfaces emit on their outside alone: 'flip' turns them, 'two_sided' makes both "
                              "sides emit",
                              photons ? "no photon found the way: try more of them, or user paths"
                                      : "it comes where paths from the eye don't find it: try ipm or mps"));
}

void report_lost_caustics(const Scene& scene, RenderStats& stats, bool looks_through) {
    if (!may_light_specular(scene)) return;
    stats.warn(Doubt::caustics,
               fmt::format("light from emitters without extent that comes through specular surfaces is missing{}, or "
                           "what is seen of it in others: no path that is {} can carry it. {}",
                           looks_through ? ", but for what comes straight through clear glass" : "",
                           looks_through ? "traced from the eye" : "joined to the eye",
                           scene.has_scattering_media()
                               ? "Photons of light paths could, but aren't to be had where a medium scatters: give "
                                 "the emitters some extent"
                               : "Photons of light paths can, such as ipm's; a longer time lets auto choose them "
                                 "where that light is worth it"));
}

void report_sun_behind_glass(const Scene& scene, RenderStats& stats) {
    if (!std::ranges::any_of(scene.emitters(), [](const auto& e) { return is_sun(*e); })) return;
    bool clear = false, glossy = false;
    for (const Shape& shape : scene.shapes()) {
        if (shape.material == nullptr) continue;
        const BsdfTraits traits = shape.material->traits();
        clear = clear || traits.clear != ClearGlass::none;
        glossy = glossy || (traits.glossy && !traits.through);
    }
    if (!clear || !glossy) return;
    stats.warn(Doubt::caustics,
               "where the sun shines in through clear glass, what glossy surfaces show of its light is "
               "found by rare samples, and mostly missing: this method doesn't look through glass. "
               "path, ipm and mps do");
}

} // namespace keyhole
