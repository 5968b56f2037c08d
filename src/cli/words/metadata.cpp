#include "cli/words/metadata.h"

#include "core/bytes.h"

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

std::map<std::string, std::string> render_identity(const Settings& settings, std::uint64_t scene_hash,
                                                   const UserPathFile& user_paths) {
    Hash paths;
    paths.add(std::string_view(user_paths_text(user_paths, "")));
    return {{"user paths", user_paths.paths.empty() ? "none" : fmt::format("{:016x}", paths.value())},
            {"program", "keyhole " KEYHOLE_VERSION},
            {"settings", settings_text(settings)},
            {"seed", std::to_string(settings.seed)},
            {"scene hash", fmt::format("{:016x}", scene_hash)}};
}

std::map<std::string, std::string> picture_metadata(const std::string& command_line, const std::string& scene,
                                                    const RenderStats& stats) {
    std::string warnings;
    for (const std::string& w : stats.warnings) warnings += w + "\n";
    std::map<std::string, std::string> metadata{{"command", command_line},
                                                {"scene", scene},
                                                {"samples", fmt::format("{}", stats.samples)},
                                                {"warnings", warnings},
                                                {"complete", stats.complete ? "yes" : "no"}};
    double wall = 0, cpu = 0;
    std::uint64_t rays = 0;
    for (const StageStats& s : stats.stages) {
        metadata[fmt::format("stage {}", s.stage->name)] =
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
