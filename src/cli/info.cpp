// keyhole info: what a scene consists of, as text or JSON.
#include "cli/program.h"
#include "cli/words/report.h"
#include "cli/words/units.h"
#include "scene/geometry.h"
#include "scene/load/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
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
    std::size_t textures = 0;
    for (const LoadedImage& image : images) textures += image.bytes;
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return {{"geometry", geometry_bytes(scene.shapes())},
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

Json scene_info(const std::string& path) {
    std::vector<std::string> warnings;
    const auto start = Clock::now();
    LoadedScene loaded = load(path, {}, &warnings);
    const double read = seconds_since(start);
    const auto middle = Clock::now();
    const Scene scene(std::move(loaded.description));
    const double build = seconds_since(middle);

    const std::vector<Shape>& shapes = scene.shapes();
    std::vector<LoadedImage> images = loaded_images();
    std::ranges::copy(loaded_pictures(), std::back_inserter(images));
    std::size_t held = 0;
    for (const TriangleMesh* mesh : held_meshes(shapes)) held += mesh->triangles.size();
    const auto count = [&](auto test) { return std::ranges::count_if(shapes, test); };
    return {{"scene", path},
            {"resolution", {scene.camera().window().width, scene.camera().window().height}},
            {"camera", camera_json(scene.camera().parameters())},
            {"bounds", {{"lower", vector_json(scene.lower())}, {"upper", vector_json(scene.upper())}}},
            {"shapes", shapes.size()},
            {"triangles", scene.triangle_count()},
            {"triangles_held", held},
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

/// Lists longer than this end in a summary; --json has all of it.
constexpr std::size_t kMostLines = 12;

void line(const char* name, const std::string& text) { fmt::print("{:<12}{}\n", name, text); }

std::string vector(const Json& v) {
    return fmt::format("{:.5g} {:.5g} {:.5g}", v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
}

std::string bytes(const Json& n) { return with_prefix(n.get<double>()) + "B"; }

void print_emitters(const Json& emitters) {
    std::vector<const Json*> sorted;
    for (const Json& e : emitters) sorted.push_back(&e);
    std::ranges::stable_sort(
        sorted, [](const Json* a, const Json* b) { return (*a)["power"].get<double>() > (*b)["power"].get<double>(); });
    for (std::size_t i = 0; i < std::min(sorted.size(), kMostLines); ++i) {
        const Json& e = *sorted[i];
        const std::string place = e.contains("center") ? "at " + vector(e["center"]) : "far away";
        line("",
             fmt::format("{}: {}W, {}", e["kind"].get<std::string>(), with_prefix(e["power"].get<double>()), place));
    }
    if (sorted.size() > kMostLines) line("", fmt::format("and {} of less power", sorted.size() - kMostLines));
}

void print_textures(const Json& textures) {
    for (std::size_t i = 0; i < std::min(textures.size(), kMostLines); ++i) {
        const Json& t = textures[i];
        line("", fmt::format("{}: {} x {}, {} channels, {}", t["file"].get<std::string>(), t["width"].get<int>(),
                             t["height"].get<int>(), t["channels"].get<int>(), bytes(t["bytes"])));
    }
    if (textures.size() > kMostLines) line("", fmt::format("and {} more", textures.size() - kMostLines));
}

void print_text(const Json& info) {
    const Json &camera = info["camera"], &memory = info["memory"];
    line("film", fmt::format("{} x {} pixels", info["resolution"][0].get<int>(), info["resolution"][1].get<int>()));
    line("camera", fmt::format("at {}, looking along {}, field of view {:.4g} degrees{}", vector(camera["position"]),
                               vector(camera["direction"]), camera["fov"].get<double>(),
                               camera["lens_radius"].get<double>() > 0 ? ", thin lens" : ""));
    line("bounds", fmt::format("{} to {}", vector(info["bounds"]["lower"]), vector(info["bounds"]["upper"])));
    const auto triangles = info["triangles"].get<std::size_t>(), held = info["triangles_held"].get<std::size_t>();
    line("shapes",
         fmt::format("{}: {} triangles{}, {} spheres, {} lights; {} instances", info["shapes"].get<int>(), triangles,
                     held != triangles ? fmt::format(" ({} held)", held) : "", info["spheres"].get<int>(),
                     info["emitting_shapes"].get<int>(), info["instances"].get<std::size_t>()));
    std::string materials;
    for (const auto& [kind, count] : info["materials"].items())
        materials += fmt::format("{}{} {}", materials.empty() ? "" : ", ", count.get<int>(), kind);
    line("materials", materials);
    line("emitters", fmt::format("{}, {}W", info["emitters"].size(), with_prefix(info["power"].get<double>())));
    print_emitters(info["emitters"]);
    line("textures", fmt::format("{}, {}", info["textures"].size(), bytes(memory["textures"])));
    print_textures(info["textures"]);
    line("memory", fmt::format("geometry {}, Embree {}, textures {}; peak of the program {}", bytes(memory["geometry"]),
                               bytes(memory["embree"]), bytes(memory["textures"]), bytes(memory["peak"])));
    line("time", fmt::format("{} to read, {} to build", duration(info["seconds"]["read"].get<double>()),
                             duration(info["seconds"]["build"].get<double>())));
    for (const Json& warning : info["warnings"]) line("warning", warning.get<std::string>());
}

} // namespace

void add_info_command(CLI::App& app, Action& action) {
    struct Options {
        std::string scene;
        bool json = false;
    };
    CLI::App* command = app.add_subcommand("info", "Print what a scene consists of");
    auto o = std::make_shared<Options>();
    command->add_option("SCENE", o->scene, "scene file (YAML, .pbrt, .gltf or .glb)")->required();
    command->add_flag("--json", o->json, "print one JSON object");
    command->callback([&action, o] {
        action = [o] {
            const Json info = scene_info(o->scene);
            if (o->json)
                fmt::print("{}\n", json_text(info));
            else
                print_text(info);
            return kSuccess;
        };
    });
}

} // namespace keyhole
