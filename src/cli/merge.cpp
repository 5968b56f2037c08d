// keyhole merge: several pictures of one scene made into one.
#include "cli/pictures/files_apart.h"
#include "cli/pictures/outputs.h"
#include "cli/program.h"
#include "cli/words/tell.h"
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

/// As it was rendered: what is joined is filtered afterwards.
Picture unfiltered(Picture picture) {
    const auto layer = picture.layers.extract("unfiltered");
    if (!layer.empty()) picture.layers["beauty"] = std::move(layer.mapped());
    return picture;
}

int merge(MergeOptions o) {
    if (!o.no_png && o.outputs.png.empty()) o.outputs.png = default_png(o.outputs.exr);
    o.outputs.check();
    std::vector<NamedFile> inputs;
    for (const std::string& path : o.inputs) inputs.push_back({"a picture to merge", path});
    check_apart(o.outputs.files(), inputs);
    std::vector<NamedPicture> pictures;
    for (const std::string& path : o.inputs) pictures.push_back({path, unfiltered(read_exr(path))});
    Picture joined = join_pictures(pictures);
    const auto settings = settings_of(pictures.front());
    if (const auto word = settings.find("denoise"); word != settings.end())
        o.outputs.denoise = choice_of<Denoise>(word->second.substr(word->second.find('=') + 1)).value_or(Denoise::png);
    const auto noise = settings.find("noise_layers");
    o.outputs.noise_layers = noise != settings.end() && noise->second == "noise_layers=true";
    joined.metadata["command"] = o.command_line;
    const bool share = !joined.sums.empty();
    const int width = joined.width, height = joined.height;
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    const Denoising denoising(o.outputs.denoise, !o.outputs.png.empty(), pixels, 0);
    const std::string whole = joined.metadata["units"], all = joined.metadata["units of all"];
    RenderStats stats;
    o.outputs.write(
        std::move(joined), [&](const Picture& picture) { return denoising.apply(picture, StopToken(), stats); },
        [] { return std::string(); });
    tell("{}: {} x {} pixels{}\n", o.outputs.exr, width, height,
         share ? fmt::format(", a share, units {} of {}", whole, all) : "");
    return kSuccess;
}

} // namespace

void add_merge_command(CLI::App& app, Action& action, const std::string& command_line) {
    CLI::App* command = app.add_subcommand("merge", "Join shares of a render, or average renders of different seeds");
    auto o = std::make_shared<MergeOptions>();
    o->command_line = command_line;
    command->add_option("PICTURES", o->inputs, "pictures of one scene with the same settings (EXR)")
        ->required()
        ->expected(2, 1 << 20)
        ->type_name("EXR EXR ...");
    command->add_option("-o,--output", o->outputs.exr, "picture to write (.exr)")->required();
    auto* png = command->add_option("--png", o->outputs.png, "tone-mapped picture; default: beside the EXR");
    command->add_flag("--no-png", o->no_png, "write no tone-mapped picture")->excludes(png);
    command->callback([&action, o] { action = [o] { return merge(*o); }; });
}

} // namespace keyhole
