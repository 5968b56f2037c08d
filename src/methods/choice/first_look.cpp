#include "methods/choice/first_look.h"

#include "methods/method.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace keyhole {
namespace {

/// Who stops a render waits this much longer at most, and has no black pixels where that is enough.
constexpr double kPathSeconds = 0.9;

double pixels(const Picture& picture) { return static_cast<double>(picture.width) * picture.height; }

} // namespace

double empty_pixels(const RenderResult& result) { return static_cast<double>(result.stats.no_samples.value_or(0)); }

bool has_picture(const RenderResult& result) {
    if (result.picture.layers.empty()) return false; // no unit of a group's
    if (!result.picture.sums.empty()) return result.stats.samples > 0;
    if (!result.stats.complete && !(result.stats.samples > 0) && result.stats.proposals.empty() &&
        !result.stats.no_samples)
        return false; // chains that had no time for a step
    return empty_pixels(result) < pixels(result.picture);
}

RenderResult first_look(const Scene& scene, const Settings& settings) {
    Settings s = settings;
    s.method = &methods::path;
    s.spp = s.passes = 1;
    StopToken stop;
    stop.set_deadline(StopToken::Clock::now() + std::chrono::duration_cast<StopToken::Clock::duration>(
                                                    std::chrono::duration<double>(kPathSeconds)));
    RunContext context;
    context.stop = &stop;
    Findings findings;
    RenderResult result = render_by_method({scene, s, {}, context, {}, findings});
    result.settings = settings;
    result.stats.complete = false;
    std::string warning = fmt::format(
        "{} was stopped before it had a picture: this is a sample a pixel by path tracing", settings.method->name);
    if (const double empty = empty_pixels(result); empty > 0)
        warning += fmt::format(", and {:.2g} % of the pixels have none", 100 * empty / pixels(result.picture));
    result.stats.warnings = {std::move(warning)};
    return result;
}

} // namespace keyhole
