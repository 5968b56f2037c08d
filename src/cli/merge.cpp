// keyhole merge: several pictures of one scene made into one.
#include "cli/command.h"
#include "cli/pictures/denoising.h"
#include "cli/pictures/outputs.h"
#include "film/files/exr.h"
#include "film/join.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

struct MergeOptions {
    std::string command_line;
    std::vector<std::string> inputs;
    Outputs outputs;
    bool no_png = false;
};

int merge(MergeOptions o) {
    if (!o.no_png && o.outputs.png.empty()) o.outputs.png = default_png(o.outputs.exr);
    o.outputs.check();
    std::vector<NamedPicture> pictures;
    for (const std::string& path : o.inputs) pictures.push_back({path, read_exr(path)});
    Picture joined = join_pictures(pictures);
    joined.metadata["command"] = o.command_line;
    const auto pixels = static_cast<std::size_t>(joined.width) * static_cast<std::size_t>(joined.height);
    RenderStats stats;
    o.outputs.write(joined, Denoising(o.outputs.denoise, !o.outputs.png.empty(), pixels, 0).apply(joined, false, stats),
                    {});
    const auto units = joined.metadata.find("units");
    if (!joined.sums.empty() && units != joined.metadata.end())
        fmt::print(stderr, "{}: a share, {} of {}\n", o.outputs.exr, units->second, joined.metadata["units of all"]);
    return kSuccess;
}

} // namespace

void add_merge_command(CLI::App& app, Action& action, const std::string& command_line) {
    CLI::App* command = app.add_subcommand("merge", "Join shares of a render, or average renders of different seeds");
    auto o = std::make_shared<MergeOptions>();
    o->command_line = command_line;
    command->add_option("PICTURES", o->inputs, "pictures of one scene with the same settings (EXR)")
        ->required()
        ->expected(2, 1 << 20);
    command->add_option("-o,--output", o->outputs.exr, "picture to write (.exr)")->required();
    auto* png = command->add_option("--png", o->outputs.png, "tone-mapped picture; default: beside the EXR");
    command->add_flag("--no-png", o->no_png, "write no tone-mapped picture")->excludes(png);
    command->callback([&action, o] { action = [o] { return merge(*o); }; });
}

} // namespace keyhole
