#include "render/first_look.h"

#include "render/methods.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

/// Who stops a render waits a second at most.
constexpr double kSeconds = 0.5;

double pixels(const Picture& picture) { return static_cast<double>(picture.width) * picture.height; }

} // namespace

double empty_pixels(const RenderResult& result) {
    const auto empty = result.stats.values.find("empty pixels");
    return empty != result.stats.values.end() ? empty->second : 0;
}

bool has_picture(const RenderResult& result) {
    if (result.picture.layers.empty()) return false; // no unit of a team's
    if (!result.picture.sums.empty()) return result.stats.samples > 0;
    if (!result.stats.complete && !(result.stats.samples > 0) && result.stats.proposals.empty() &&
        !result.stats.values.contains("empty pixels"))
        return false; // chains that had no time for a step
    return empty_pixels(result) < pixels(result.picture);
}

RenderResult first_look(const Scene& scene, const Settings& settings) {
    Settings s = settings;
    s.method = "path";
    s.spp = s.passes = 1;
    StopToken stop;
    stop.set_deadline(StopToken::Clock::now() +
                      std::chrono::duration_cast<StopToken::Clock::duration>(std::chrono::duration<double>(kSeconds)));
    RunContext context;
    context.stop = &stop;
    RenderResult result = render_path(scene, s, context, {});
    result.stats.method = s.method;
    result.settings = settings;
    result.stats.complete = false;
    result.stats.warnings = {fmt::format("{} was stopped before it had a picture: this is a sample a pixel by path "
                                         "tracing, and {:.0f} % of the pixels have none",
                                         settings.method, 100 * empty_pixels(result) / pixels(result.picture))};
    return result;
}

} // namespace keyhole
