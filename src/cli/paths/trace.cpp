// keyhole paths trace: follows a ray from a light, and prints the points that it meets, as a user path to paste.
#include "cli/command.h"
#include "cli/paths/paths.h"
#include "core/error.h"
#include "sampling/guidance/light_ray.h"
#include "sampling/guidance/nearest_emitter.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

struct TraceOptions {
    std::string scene;
    std::vector<double> from, direction;
    bool reflect = false;
    std::size_t most = 16;
};

std::string line(const Vec3& p, std::string_view what) {
    return fmt::format("      - [{:.6g}, {:.6g}, {:.6g}]  # {}\n", p.x, p.y, p.z, what);
}

const char* describe(const Vertex& v) {
    if (v.event == Event::reflect) return "reflects";
    if (v.event == Event::transmit) return "transmits";
    if (v.point.is_emitter()) return "an emitter";
    return v.bsdf.traits().finite ? "scatters" : "absorbs";
}

/// Where the ray starts: on a light near the given place, or else there, off whatever surface is near.
SurfacePoint start_of(const Scene& scene, const Imath::V3d& from, const Vec3& w, bool& on_light) {
    const double size = (scene.upper() - scene.lower()).length();
    const auto nearest = nearest_emitter_point(scene, from, from + Imath::V3d(w));
    on_light = nearest && nearest->distance <= 0.01 * size;
    if (on_light) return nearest->point;
    SurfacePoint point;
    point.site = Site::point;
    point.p = Vec3(from + Imath::V3d(w) * (1e-4 * size));
    return point;
}

int trace(const TraceOptions& o) {
    const Vec3 direction(Imath::V3d(o.direction[0], o.direction[1], o.direction[2]));
    if (!(direction.length() > 0)) throw InputError("found --dir of no length, expected a direction");
    LoadedScene loaded = load(o.scene);
    const Scene scene(std::move(loaded.description));
    const Vec3 w = direction.normalized();
    bool on_light = false;
    const SurfacePoint start = start_of(scene, {o.from[0], o.from[1], o.from[2]}, w, on_light);
    const auto found = follow_light(scene, start, w, o.most, o.reflect ? AtGlass::reflect : AtGlass::transmit);
    if (found.empty()) throw InputError("found nothing in the direction of the ray, expected a surface");
    std::string text = "  - points:\n" + line(start.p, on_light ? "the light" : "no light is near");
    for (const Vertex& v : found) text += line(v.point.p, describe(v));
    fmt::print("{}", text);
    return kSuccess;
}

} // namespace

void add_paths_trace_command(CLI::App& paths, Action& action) {
    CLI::App* command = paths.add_subcommand("trace", "Follow a ray of light and print the points it meets");
    auto o = std::make_shared<TraceOptions>();
    command->add_option("SCENE", o->scene, "scene file")->required();
    command->add_option("--from", o->from, "where it starts, X Y Z; a light near by is taken")->required()->expected(3);
    command->add_option("--dir", o->direction, "its direction, X Y Z")->required()->expected(3);
    command->add_flag("--reflect", o->reflect, "reflect at glass; it is transmitted otherwise");
    command->add_option("--most", o->most, "most points after the first")->check(CLI::Range(1, 30));
    command->callback([&action, o] { action = [o] { return trace(*o); }; });
}

} // namespace keyhole
