#include "cli/inspect/page_data.h"

#include "cli/inspect/page_arrays.h"
#include "cli/page/page_parts.h"
#include "cli/pictures/beauty.h"
#include "cli/words/metadata.h"
#include "cli/words/report.h"
#include "film/tonemap.h"
#include "sampling/guidance/nearest_emitter.h"
#include "sampling/guidance/user_paths.h"
#include "scene/load/yaml/user_path_file.h"
#include "scene/scene.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace keyhole {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const auto& v) { return {v.x, v.y, v.z}; }

/// Degrees as they were given, but for the last digits that the way to radians and back costs.
double degrees(double radians) {
    const double d = radians * 180 / kPi;
    return std::stod(fmt::format("{:.12g}", d));
}

Json points_json(const UserPathSpec& path) {
    Json points = Json::array();
    for (const UserPathPoint& p : path.points) {
        if (p.bounce) continue;
        Json point{{"p", vector_json(p.p)}};
        if (p.through)
            point["through"] = {{"corner", vector_json(p.through->corner)},
                                {"u", vector_json(p.through->u)},
                                {"v", vector_json(p.through->v)}};
        points.push_back(point);
    }
    return points;
}

/// An entry as in the file, with its angles in degrees; `paths`, the names of the paths that it stands for; what became
/// of the first in the scene: `error`, or `signature` and `seen`.
Json entry_json(const UserPathEntry& of, const Scene& scene) {
    const UserPathSpec& first = of.paths.front();
    Json names = Json::array(), beta = Json::array();
    for (const UserPathSpec& path : of.paths) names.push_back(path.name);
    for (std::size_t i = of.least_bounces; i < first.beta.size(); ++i) beta.push_back(degrees(first.beta[i]));
    Json entry{{"name", of.name},
               {"weight", std::stod(fmt::format("{:.12g}", of.weight))},
               {"paths", names},
               {"beta", beta},
               {"patch", first.patch ? Json(*first.patch) : Json()},
               {"tolerance", first.tolerance ? Json(*first.tolerance) : Json()},
               {"bounces", of.most_bounces > 0 ? Json{of.least_bounces, of.most_bounces} : Json()},
               {"points", points_json(first)}};
    try {
        const UserPath bound = bind_user_path(scene, first);
        entry["signature"] = bound.signature();
        entry["seen"] = bound.seen;
    } catch (const InputError& e) {
        entry["error"] = e.what();
    }
    return entry;
}

/// To a millionth of `size`, or nearly.
Json rounded(const Vec3& v, double size) {
    const int digits = std::max(0, 6 - static_cast<int>(std::floor(std::log10(size))));
    Json list = Json::array();
    for (int i = 0; i < 3; ++i) list.push_back(std::stod(fmt::format("{:.{}f}", v[i], digits)) + 0.0);
    return list;
}

/// The frame, and where the film's borders lie on the plane at distance 1, to the right and up.
Json camera_json(const Camera& camera) {
    const CameraParameters& c = camera.parameters();
    const ImageWindow& window = camera.window();
    const SurfacePoint eye = camera.eye(0.5, 0.5);
    const auto on_plane = [&](float x, float y) {
        const Vec3 w = camera.ray_direction(eye, window.to_window({x, y}));
        return Json{w.dot(c.right) / w.dot(c.forward), w.dot(c.up) / w.dot(c.forward)};
    };
    return {{"origin", vector_json(c.origin)},
            {"right", vector_json(c.right)},
            {"up", vector_json(c.up)},
            {"forward", vector_json(c.forward)},
            {"topLeft", on_plane(0, 0)},
            {"bottomRight", on_plane(static_cast<float>(window.width), static_cast<float>(window.height))}};
}

/// The middle of an emitter, or of points drawn on it the one that is nearest to theirs.
Vec3 place_on(const Scene& scene, std::uint32_t index) {
    constexpr double kOnIt = 1e-4; // but for rounding
    const Emitter& emitter = scene.emitter(index);
    if (const auto bounds = emitter.bounds()) {
        const Imath::V3d middle((bounds->lower + bounds->upper) / 2);
        const auto nearest = nearest_emitter_point(scene, middle, middle + Imath::V3d(0, -1, 0));
        if (nearest && nearest->point.emitter == index &&
            nearest->distance < kOnIt * (bounds->upper - bounds->lower).length())
            return nearest->point.p;
    }
    Rng rng(1, StreamPurpose::inspection, index);
    std::vector<Vec3> points;
    Vec3 mean(0);
    constexpr int kTries = 64;
    for (int i = 0; i < kTries; ++i) {
        points.push_back(emitter.sample_point(rng).point.p);
        mean += points.back() / kTries;
    }
    return *std::ranges::min_element(points, {}, [&](const Vec3& p) { return (p - mean).length2(); });
}

/// The strongest first; `index` is that of photons.
Json emitters_json(const Scene& scene) {
    constexpr std::size_t kMost = 60;
    std::vector<std::uint32_t> order(scene.emitters().size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::stable_sort(order, std::greater<>(), [&](std::uint32_t i) { return scene.emitter(i).power(); });
    order.resize(std::min(kMost, order.size()));
    Json list = Json::array();
    for (const std::uint32_t i : order) {
        const Emitter& emitter = scene.emitter(i);
        Json entry{{"index", i}, {"kind", emitter.kind()}, {"power", emitter.power()}};
        entry["p"] = emitter.site() == Site::infinite
                         ? Json()
                         : rounded(place_on(scene, i), (scene.upper() - scene.lower()).length());
        list.push_back(entry);
    }
    return list;
}

Json film_json(const Inspection& inspection) {
    const Image &a = inspection.render.picture.layers.at("beauty"), &b = inspection.again.picture.layers.at("beauty");
    return {
        {"width", a.width}, {"height", a.height}, {"picture", png_uri(a.width, a.height, 3, tonemap(mean_of(a, b)))}};
}

Json map_json(const PhotonSample::Map& map) {
    return {{"mainPhotons", map.main_photons}, {"pilots", map.pilots}, {"power", map.power}};
}

Json counts_json(const Inspection& i) {
    return {{"global", map_json(i.photons.global)},
            {"caustic", map_json(i.photons.caustic)},
            {"refused", i.photons.refused},
            {"importons", i.importon_count},
            {"records", i.record_count},
            {"gatheredEverywhere", i.gathered_everywhere},
            {"learnedDirectLight", i.learned_direct_light},
            {"triangles", i.surface.of_scene},
            {"firstEmitter", i.surface.emitters},
            {"firstClear", i.surface.clear}};
}

const char* word(Doubt about) {
    switch (about) {
    case Doubt::render:
        break;
    case Doubt::scene:
        return "scene";
    case Doubt::samples:
        return "samples";
    case Doubt::direct_light:
        return "direct";
    case Doubt::caustics:
        return "caustics";
    case Doubt::photons:
        return "photons";
    case Doubt::lookups:
        return "lookups";
    case Doubt::records:
        return "records";
    }
    return "render";
}

/// Each with what it is about.
Json warnings_json(const RenderStats& stats) {
    Json list = Json::array();
    for (const std::string& warning : stats.warnings) {
        const auto about = stats.doubts.find(warning);
        list.push_back(
            {{"text", warning}, {"about", word(about != stats.doubts.end() ? about->second : Doubt::render)}});
    }
    return list;
}

/// What the statistics know that a page has room for.
Json stats_of(const RenderResult& render) {
    Json json = stats_json(render.stats);
    const PhotonQuality& quality = render.stats.photon_quality;
    if (quality.lookups)
        json["lookups"] = {{"found", quality.lookups->found},
                           {"effective", quality.lookups->effective},
                           {"share", quality.lookups->share},
                           {"asked", render.settings.nearest}};
    if (quality.of_brightest) json["ofBrightest"] = *quality.of_brightest;
    json["photonMemory"] = render.settings.photon_memory;
    json["warnings"] = warnings_json(render.stats);
    json["settings"] = settings_text(render.settings);
    return json;
}

} // namespace

Json page_data(const Scene& scene, const Inspection& inspection, const PageSubject& subject) {
    const float far = std::max((scene.upper() - scene.lower()).length(), 1e-6f);
    Vec3 lower = scene.lower(), upper = scene.upper();
    for (int i = 0; i < 3; ++i) {
        lower[i] = std::min(lower[i], scene.camera().parameters().origin[i]) - 1.02f * far;
        upper[i] = std::max(upper[i], scene.camera().parameters().origin[i]) + 1.02f * far;
    }
    const PlaceCode surface{scene.lower(), scene.upper()}, air{lower, upper};
    BinaryData data;
    add_arrays(inspection, surface, air, far, data);
    Json user_paths = Json::array();
    for (const UserPathEntry& entry : entries_of(subject.user_paths)) user_paths.push_back(entry_json(entry, scene));
    Json json{{"program", "keyhole " KEYHOLE_VERSION},
              {"scene", subject.scene},
              {"seconds", subject.seconds},
              {"camera", camera_json(scene.camera())},
              {"film", film_json(inspection)},
              {"surface", surface.json()},
              {"air", air.json()},
              {"counts", counts_json(inspection)},
              {"emitters", emitters_json(scene)},
              {"userPaths", user_paths},
              {"stats", stats_of(inspection.render)}};
    json["binary"] = data.json();
    return json;
}

} // namespace keyhole
