// keyhole paths: tools for user paths.
#include "cli/pictures/files_apart.h"
#include "cli/pictures/outputs.h"
#include "cli/program.h"
#include "cli/words/tell.h"
#include "core/error.h"
#include "core/parallel.h"
#include "film/drawing.h"
#include "film/files/atomic_file.h"
#include "film/files/png.h"
#include "film/tonemap.h"
#include "methods/render.h"
#include "sampling/guidance/found/find_openings.h"
#include "sampling/guidance/found/suggest_paths.h"
#include "sampling/guidance/nearest_emitter.h"
#include "sampling/guidance/user_paths.h"
#include "scene/load/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

namespace keyhole {
namespace {

/// A scene, and the user paths for it.
struct SceneWithPaths {
    std::unique_ptr<Scene> scene;
    Settings settings;
    UserPathFile user_paths;
};

/// Reads a scene and a file of user paths; empty: the one that the scene names. `overrides` are settings, `resolution`
/// is WIDTHxHEIGHT or empty. @throws InputError for mistakes in either, and if there are no user paths at all.
SceneWithPaths load_with_paths(const std::string& scene, const std::string& user_paths,
                               const std::vector<std::string>& overrides = {}, const std::string& resolution = "") {
    LoadedScene loaded = load(scene, overrides);
    if (!resolution.empty()) set_resolution(loaded.description.window, resolution);
    SceneWithPaths all{nullptr, loaded.settings, std::move(loaded.user_paths)};
    if (!user_paths.empty()) all.user_paths = load_user_paths(user_paths);
    if (all.user_paths.paths.empty())
        throw InputError(scene + ": found a scene without user paths, expected a file of them as second argument");
    all.scene = std::make_unique<Scene>(std::move(loaded.description));
    return all;
}

/// Makes a command do `body` with its options, on as many threads as its --threads says.
template <class Options, class Body>
void act_on_threads(CLI::App& command, Action& action, const std::shared_ptr<Options>& options, Body body) {
    command.add_option("-t,--threads", options->threads, "threads; 0: one for each core")->check(CLI::Range(0, 4096));
    command.callback([&action, options, body] {
        action = [options, body] {
            with_threads(options->threads, [&] { body(*options); });
            return kSuccess;
        };
    });
}

// keyhole paths check: whether user paths work in a scene, one line each.

struct CheckOptions {
    std::string scene, paths;
};

/// Largest distance from a given point to the one that was found [m].
double largest_miss(const UserPathSpec& spec, const UserPath& path) {
    double most = (Imath::V3d(path.patch.center().p) - spec.points[0].p).length();
    for (std::size_t i = 0; i < path.vertices.size(); ++i)
        if (!path.vertices[i].bounce)
            most = std::max(most, (Imath::V3d(path.vertices[i].p) - spec.points[i + 1].p).length());
    return most;
}

int check(const CheckOptions& options) {
    const SceneWithPaths all = load_with_paths(options.scene, options.paths);
    std::size_t widest = 4, bad = 0;
    for (const UserPathSpec& spec : all.user_paths.paths) widest = std::max(widest, spec.name.size());
    std::string first;
    std::set<std::string> told; // entries
    fmt::print("{:<{}}  {:>6}  {:>9}  {:<14}  {}\n", "path", widest, "weight", "snapped", "vertices", "joined to");
    for (const UserPathSpec& spec : all.user_paths.paths) {
        try {
            const UserPath path = bind_user_path(*all.scene, spec);
            fmt::print("{:<{}}  {:>6.3g}  {:>7.1f}mm  {:<14}  {}\n", spec.name, widest, spec.weight,
                       1000 * largest_miss(spec, path), path.signature(),
                       path.seen ? "the current path, or the eye" : "the current path");
        } catch (const InputError& e) {
            // Paths of an entry, which differ in bounces, have the same mistake.
            if (spec.where.line > 0 && !told.insert(spec.where.to_string()).second) continue;
            fmt::print("{:<{}}  {}\n", spec.name, widest, e.what());
            if (bad++ == 0) first = e.what();
        }
    }
    if (bad == 0) return kSuccess;
    throw InputError(bad == 1 ? first : fmt::format("{} (and {} more)", first, bad - 1));
}

void add_paths_check_command(CLI::App& paths, Action& action) {
    CLI::App* command = paths.add_subcommand("check", "Say whether user paths work in a scene");
    auto o = std::make_shared<CheckOptions>();
    command->add_option("SCENE", o->scene, "scene file")->required();
    command->add_option("PATHS", o->paths, "file of user paths; default: the scene's");
    command->callback([&action, o] { action = [o] { return check(*o); }; });
}

// keyhole paths show: a preview of the scene with user paths drawn over it.

struct ShowOptions {
    std::string scene, paths, output, resolution;
    std::vector<std::string> overrides;
    int threads = 0;
};

/// Draws what the camera sees of a line, and fainter what is hidden.
class PathPainter {
  public:
    PathPainter(const Scene& scene, Canvas& canvas) : scene_(scene), canvas_(canvas), eye_(scene.camera().eye(0, 0)) {}

    void segment(const Vec3& a, const Vec3& b, const Rgb8& color) {
        constexpr int kSteps = 2000; // more than pixels across most pictures
        std::optional<Vec2> last;
        for (int i = 0; i <= kSteps; ++i) {
            const float t = static_cast<float>(i) / kSteps;
            const Vec3 p = a * (1 - t) + b * t;
            const auto at = pixel(p);
            if (!at || (last && (*at - *last).length() < 0.7f)) continue;
            last = at;
            if (sees(p))
                draw_disc(canvas_, *at, 1.1f, color);
            else if (i / 40 % 2 == 0)
                draw_disc(canvas_, *at, 0.7f, color, 0.35f);
        }
    }

    void vertex(const Vec3& p, const Rgb8& color, float radius) {
        const auto at = pixel(p);
        if (!at) return;
        const float opacity = sees(p) ? 1.0f : 0.4f;
        draw_disc(canvas_, *at, radius + 1.2f, {0, 0, 0}, opacity);
        draw_disc(canvas_, *at, radius, color, opacity);
    }

  private:
    std::optional<Vec2> pixel(const Vec3& p) const {
        const auto image = scene_.camera().image_point(eye_, (p - eye_.p).normalized());
        if (!image) return std::nullopt;
        return scene_.camera().window().to_pixel(*image);
    }
    /// A little before the point, which may lie on a surface.
    bool sees(const Vec3& p) const {
        SurfacePoint point;
        point.site = Site::point;
        point.p = p + (eye_.p - p) * 0.005f;
        return scene_.visible(eye_, point);
    }

    const Scene& scene_;
    Canvas& canvas_;
    SurfacePoint eye_;
};

void draw(const Scene& scene, const UserPath& path, const Rgb8& color, Canvas& canvas) {
    PathPainter painter(scene, canvas);
    Vec3 from = path.patch.center().p;
    for (const UserVertex& v : path.vertices) { // bounces lie in the openings
        painter.segment(from, v.p, color);
        from = v.p;
    }
    painter.vertex(path.patch.center().p, {255, 255, 255}, 4);
    for (const UserVertex& v : path.vertices) painter.vertex(v.p, color, is_specular(v.event) ? 2.0f : 3.5f);
}

void show(ShowOptions o) {
    if (o.output.empty()) o.output = default_png(default_exr(o.scene));
    check_writable(o.output);
    std::vector<std::string> overrides{"method=path", "spp=24"};
    overrides.insert(overrides.end(), o.overrides.begin(), o.overrides.end());
    SceneWithPaths all = load_with_paths(o.scene, o.paths, overrides, o.resolution);
    check_apart({{"--output", o.output}}, files_of_scene());
    const UserPaths paths = bind_user_paths(*all.scene, all.user_paths);
    const RenderResult preview = render(*all.scene, all.settings, {});
    const Image& beauty = preview.picture.layers.at("beauty");
    Canvas canvas{beauty.width, beauty.height, tonemap(beauty)};
    for (std::size_t i = 0; i < paths.size(); ++i) draw(*all.scene, paths[i], palette_color(i), canvas);
    write_png(o.output, canvas);
    tell("{}: {} paths\n", o.output, paths.size());
}

void add_paths_show_command(CLI::App& paths, Action& action) {
    CLI::App* command = paths.add_subcommand("show", "Draw user paths over a preview of the scene");
    auto o = std::make_shared<ShowOptions>();
    command->add_option("SCENE", o->scene, "scene file")->required();
    command->add_option("PATHS", o->paths, "file of user paths; default: the scene's");
    command->add_option("-o,--output", o->output, "picture to write (.png); default: the scene's name, in this folder");
    command->add_option("--resolution", o->resolution, "WIDTHxHEIGHT in pixels");
    command->add_option("-D", o->overrides, "any setting of the preview, KEY=VALUE; by default method=path, spp=24")
        ->allow_extra_args(false);
    act_on_threads(*command, action, o, show);
}

// keyhole paths suggest: user paths from the renderer itself.

constexpr std::int64_t kPathsFromEitherEnd = 8192;

struct SuggestCommand {
    std::string scene, output;
    std::vector<std::string> overrides;
    SuggestOptions options;
    int threads = 0;
};

void suggest(const SuggestCommand& o) {
    LoadedScene loaded = load(o.scene, o.overrides);
    check_apart({{"--output", o.output}}, files_of_scene());
    const Scene scene(std::move(loaded.description));
    const StageOneSettings first{.max_scatterings = static_cast<int>(loaded.settings.max_depth),
                                 .samples = loaded.settings.brightness_samples,
                                 .seed = loaded.settings.seed};
    const TransportEnds ends = trace_transport_ends(scene, kPathsFromEitherEnd, first.seed, {});
    std::vector<std::string> left_out; // of no use to who asks for what works
    UserPathFile file = usable_paths(
        scene, find_openings(scene, ends, {.max_scatterings = first.max_scatterings, .seed = first.seed}, {}).paths,
        left_out);
    // An opening says all that is to be said of light that has to pass it.
    if (file.paths.empty()) file = suggest_user_paths(scene, first, o.options);
    if (file.paths.empty()) {
        const bool sky_alone = std::ranges::all_of(
            scene.emitters(), [](const auto& emitter) { return emitter->site() == Site::infinite; });
        throw InputError(o.scene + (sky_alone ? ": found light from infinitely far away alone, expected emitters in "
                                                "the scene, at which user paths can begin"
                                              : ": found no path that carries light to the eye; try "
                                                "-D brightness_samples=..."));
    }
    const std::string text =
        user_paths_text(file, "User paths for " + o.scene + ", suggested by keyhole paths suggest");
    if (o.output.empty())
        fmt::print("{}", text);
    else
        write_file_atomically(o.output, text);
}

void add_paths_suggest_command(CLI::App& paths, Action& action) {
    CLI::App* command = paths.add_subcommand("suggest", "Find bright paths that are hard to find");
    auto o = std::make_shared<SuggestCommand>();
    command->add_option("SCENE", o->scene, "scene file")->required();
    command->add_option("-n,--number", o->options.count, "most paths")->check(CLI::Range(1, 1000));
    command->add_option("-o,--output", o->output, "file to write; default: the standard output");
    command->add_option("--radius", o->options.radius, "how far apart paths are alike, as a share of the scene's size")
        ->check(real_range(1e-4, 1.0));
    command->add_option("-D", o->overrides, "any setting of render, KEY=VALUE; may be repeated")
        ->allow_extra_args(false);
    act_on_threads(*command, action, o, suggest);
}

// keyhole paths trace: follows a ray from a light, and prints the points that it meets, as a user path to paste.

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
    if (!on_light) tell("keyhole: no light is near --from: a user path begins at one\n");
    return kSuccess;
}

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

} // namespace

void add_paths_command(CLI::App& app, Action& action) {
    CLI::App* paths = app.add_subcommand("paths", "Check, show, suggest and trace user paths");
    paths->require_subcommand(1);
    add_paths_check_command(*paths, action);
    add_paths_show_command(*paths, action);
    add_paths_suggest_command(*paths, action);
    add_paths_trace_command(*paths, action);
}

} // namespace keyhole
