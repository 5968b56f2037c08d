// keyhole diff: error measures as JSON.
#include "cli/pictures/beauty.h"
#include "cli/program.h"
#include "film/image_error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace keyhole {
namespace {

int diff(const std::vector<std::string>& paths) {
    const Image picture = read_beauty(paths[0]), reference = read_beauty(paths[1]);
    const Image second = paths.size() > 2 ? read_beauty(paths[2]) : Image();
    const ImageError e = image_error(picture, reference, paths.size() > 2 ? &second : nullptr);
    // NaN becomes null.
    nlohmann::ordered_json json{{"relmse", e.relmse},   {"relmse_trim", e.relmse_trim},
                                {"rms_rel", e.rms_rel}, {"ratio", e.ratio},
                                {"block", e.block},     {"bad", e.bad}};
    if (e.cross) {
        json["cross"] = *e.cross;
        json["cross_trim"] = *e.cross_trim;
    }
    fmt::print("{}\n", json.dump());
    return kSuccess;
}

} // namespace

void add_diff_command(CLI::App& app, Action& action) {
    CLI::App* command = app.add_subcommand("diff", "Print how far a picture is from one or two references");
    auto paths = std::make_shared<std::vector<std::string>>();
    command->add_option("FILES", *paths, "picture, reference and, optionally, a second, independent reference (EXR)")
        ->required()
        ->expected(2, 3);
    command->callback([&action, paths] { action = [paths] { return diff(*paths); }; });
}

} // namespace keyhole
