#include "cli/scene_info.h"

#include "scene/geometry.h"
#include "scene/load/load.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <sys/resource.h>

namespace keyhole {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Json vector_json(const Vec3& v) { return {v.x, v.y, v.z}; }

/// How many different materials of each kind the shapes have.
Json materials_json(const std::vector<Shape>& shapes) {
    std::set<const Material*> seen;
    std::map<std::string, int> counts;
    for (const Shape& shape : shapes)
        if (seen.insert(shape.material.get()).second) ++counts[shape.material ? shape.material->kind() : "none"];
    return counts;
}

Json emitters_json(const Scene& scene) {
    Json list = Json::array();
    for (const auto& emitter : scene.emitters()) {
        Json entry{{"kind", emitter->kind()}, {"power", emitter->power()}};
        if (const auto bounds = emitter->bounds()) entry["center"] = vector_json((bounds->lower + bounds->upper) / 2);
        list.push_back(entry);
    }
    return list;
}

double total_power(const Scene& scene) {
    double sum = 0;
    for (const auto& emitter : scene.emitters()) sum += emitter->power();
    return sum;
}

Json textures_json(const std::vector<LoadedImage>& images) {
    Json list = Json::array();
    for (const LoadedImage& i : images)
        list.push_back(
            {{"file", i.path}, {"width", i.width}, {"height", i.height}, {"channels", i.channels}, {"bytes", i.bytes}});
    return list;
}

Json memory_json(const Scene& scene, const std::vector<LoadedImage>& images) {
    std::size_t geometry = 0, textures = 0;
    for (const Shape& shape : scene.shapes()) geometry += geometry_bytes(shape);
    for (const LoadedImage& image : images) textures += image.bytes;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return {{"geometry", geometry},
            {"embree", scene.accelerator_bytes()},
            {"textures", textures},
            {"peak", static_cast<std::int64_t>(usage.ru_maxrss) * 1024}};
}

Json camera_json(const CameraParameters& camera) {
    return {{"position", vector_json(camera.origin)},
            {"direction", vector_json(camera.forward)},
            {"right", vector_json(camera.right)},
            {"up", vector_json(camera.up)},
            {"fov", camera.fov_degrees},
            {"lens_radius", camera.lens_radius},
            {"focus_distance", camera.focus_distance}};
}

} // namespace

Json scene_info(const std::string& path) {
    std::vector<std::string> warnings;
    const auto start = Clock::now();
    LoadedScene loaded = load(path, {}, &warnings);
    const double read = seconds_since(start);
    const auto middle = Clock::now();
    const Scene scene(std::move(loaded.description));
    const double build = seconds_since(middle);

    const std::vector<Shape>& shapes = scene.shapes();
    const std::vector<LoadedImage> images = loaded_images();
    const auto count = [&](auto test) { return std::ranges::count_if(shapes, test); };
    return {{"scene", path},
            {"resolution", {scene.camera().window().width, scene.camera().window().height}},
            {"camera", camera_json(scene.camera().parameters())},
            {"bounds", {{"lower", vector_json(scene.lower())}, {"upper", vector_json(scene.upper())}}},
            {"shapes", shapes.size()},
            {"triangles", scene.triangle_count()},
            {"spheres", count([](const Shape& s) { return std::holds_alternative<Sphere>(s.geometry); })},
            {"emitting_shapes", count([](const Shape& s) { return s.emission != nullptr; })},
            {"instances", loaded.instances},
            {"materials", materials_json(shapes)},
            {"emitters", emitters_json(scene)},
            {"power", total_power(scene)},
            {"textures", textures_json(images)},
            {"memory", memory_json(scene, images)},
            {"seconds", {{"read", read}, {"build", build}}},
            {"warnings", warnings}};
}

} // namespace keyhole
