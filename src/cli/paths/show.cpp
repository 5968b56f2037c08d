// keyhole paths show: a preview of the scene with user paths drawn over it.
#include "cli/paths/paths.h"
#include "cli/pictures/outputs.h"
#include "cli/words/tell.h"
#include "film/drawing.h"
#include "film/files/atomic_file.h"
#include "film/files/png.h"
#include "film/tonemap.h"
#include "methods/render.h"
#include "sampling/guidance/user_paths.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

struct ShowOptions {
    std::string scene, paths, output, resolution;
    std::vector<std::string> overrides;
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

int show(ShowOptions o) {
    if (o.output.empty()) o.output = default_png(default_exr(o.scene));
    check_writable(o.output);
    std::vector<std::string> overrides{"method=path", "spp=24"};
    overrides.insert(overrides.end(), o.overrides.begin(), o.overrides.end());
    SceneWithPaths all = load_with_paths(o.scene, o.paths, overrides, o.resolution);
    const UserPaths paths = bind_user_paths(*all.scene, all.user_paths);
    const RenderResult preview = render(*all.scene, all.settings, {});
    const Image& beauty = preview.picture.layers.at("beauty");
    Canvas canvas{beauty.width, beauty.height, tonemap(beauty)};
    for (std::size_t i = 0; i < paths.size(); ++i) draw(*all.scene, paths[i], palette_color(i), canvas);
    write_png(o.output, canvas);
    tell("{}: {} paths\n", o.output, paths.size());
    return kSuccess;
}

} // namespace

void add_paths_show_command(CLI::App& paths, Action& action) {
    CLI::App* command = paths.add_subcommand("show", "Draw user paths over a preview of the scene");
    auto o = std::make_shared<ShowOptions>();
    command->add_option("SCENE", o->scene, "scene file")->required();
    command->add_option("PATHS", o->paths, "file of user paths; default: the scene's");
    command->add_option("-o,--output", o->output, "picture to write (.png); default: the scene's name, in this folder");
    command->add_option("--resolution", o->resolution, "WIDTHxHEIGHT in pixels");
    command->add_option("-D", o->overrides, "any setting of the preview, KEY=VALUE; by default method=path, spp=24")
        ->allow_extra_args(false);
    command->callback([&action, o] { action = [o] { return show(*o); }; });
}

} // namespace keyhole
