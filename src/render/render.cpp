#include "render/render.h"

#include "core/error.h"
#include "film/filter.h"
#include "render/methods.h"

#include <algorithm>

namespace keyhole {
namespace {

RenderResult render_by_method(const Scene& scene, const Settings& settings, const UserPaths& paths,
                              const RunContext& context, const Share& share) {
    if (settings.method == "path") return render_path(scene, settings, context, share);
    if (settings.method == "mlt") return render_mlt(scene, settings, paths, context, share);
    if (settings.method == "bdpt") return render_bdpt(scene, settings, context, share);
    if (settings.method == "pssmlt" || settings.method == "mmlt" || settings.method == "rjmlt")
        return render_primary(scene, settings, context, share);
    if (keeps_photons(settings.method)) return render_photons(scene, settings, paths, context, share);
    throw InputError("unknown method '" + settings.method + "'");
}

} // namespace

void set_window_margin(Scene& scene, const Settings& settings) {
    ImageWindow window = scene.camera().window();
    window.margin = std::max({2.0f, 0.03f * static_cast<float>(std::max(window.width, window.height)),
                              static_cast<float>(PixelFilter(settings).radius())});
    scene.set_window(window);
}

RenderResult render(Scene& scene, const Settings& settings, const RunContext& context, const UserPathFile& user_paths,
                    const Share& share) {
    set_window_margin(scene, settings);
    RenderResult result = render_by_method(scene, settings, bind_user_paths(scene, user_paths), context, share);
    if (result.stats.method.empty()) result.stats.method = settings.method;
    result.settings = settings;
    return result;
}

} // namespace keyhole
