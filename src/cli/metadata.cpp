#include "cli/metadata.h"

#include <fmt/format.h>

#include <sys/resource.h>

namespace keyhole {

std::string settings_text(const Settings& settings) {
    std::string text;
    visit_settings(settings, [&](const char* key, const auto& value, const auto&...) {
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", key, printable(value));
    });
    return text;
}

std::map<std::string, std::string> picture_metadata(const std::string& command_line, const std::string& scene,
                                                    const Settings& settings, const RenderStats& stats) {
    std::map<std::string, std::string> metadata{{"program", "keyhole " KEYHOLE_VERSION},
                                                {"command", command_line},
                                                {"scene", scene},
                                                {"seed", std::to_string(settings.seed)},
                                                {"settings", settings_text(settings)},
                                                {"complete", stats.complete ? "yes" : "no"}};
    double wall = 0, cpu = 0;
    std::uint64_t rays = 0;
    for (const StageStats& s : stats.stages) {
        metadata["stage " + s.name] =
            fmt::format("{:.3f} s wall, {:.3f} s CPU, {} rays", s.wall_seconds, s.cpu_seconds, s.rays);
        wall += s.wall_seconds;
        cpu += s.cpu_seconds;
        rays += s.rays;
    }
    metadata["seconds"] = fmt::format("{:.3f} wall, {:.3f} CPU", wall, cpu);
    metadata["rays"] = std::to_string(rays);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    metadata["peak memory"] = fmt::format("{} KiB", usage.ru_maxrss);
    return metadata;
}

} // namespace keyhole
