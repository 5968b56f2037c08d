#include "cli/checkpoints.h"

#include "cli/program.h"
#include "cli/words/tell.h"
#include "core/error.h"
#include "core/work_item_set.h"
#include "film/files/exr.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <system_error>

namespace keyhole {
namespace {

/// Between checkpoints of a render that goes on, where nobody says.
constexpr double kSeconds = 600;

namespace fs = std::filesystem;

std::pair<std::int64_t, std::int64_t> parse_range(const std::string& text) {
    std::int64_t begin = 0, end = 0;
    const char *at = text.data(), *last = at + text.size();
    const auto colon = std::from_chars(at, last, begin);
    const bool half = colon.ec == std::errc() && colon.ptr != last && *colon.ptr == ':';
    const auto rest = half ? std::from_chars(colon.ptr + 1, last, end) : colon;
    if (!half || rest.ec != std::errc() || rest.ptr != last || begin < 0 || end <= begin)
        throw InputError(fmt::format("--pass-range: found '{}', expected A:B, the passes from A (counted from 0) to "
                                     "before B",
                                     text));
    return {begin, end};
}

} // namespace

void Checkpoints::add_options(CLI::App& command) {
    command.add_option("--pass-range", pass_range,
                       "A:B, render only passes A to B-1, counted from 0; `keyhole merge` joins the shares");
    command
        .add_option("--checkpoint", checkpoint,
                    "every so many SECONDS keep what is done, beside the picture as NAME.checkpoint.exr")
        ->check(real_range(0.0, 1e9));
    command.add_flag("--resume", resume, "go on from that file");
}

std::string Checkpoints::file(const std::string& exr, int rank) const {
    if (!checkpoint && !resume) return {};
    const std::string ending = rank == 0 ? ".checkpoint.exr" : fmt::format(".checkpoint.{}.exr", rank);
    return fs::path(exr).replace_extension(ending).string();
}

std::vector<std::string> Checkpoints::found(const std::string& exr) const {
    if (file(exr).empty()) return {};
    const fs::path own(file(exr));
    std::set<int> ranks;
    std::error_code error; // of a name that is too long, or no folder: that it can't be written is said elsewhere
    for (const auto& entry : fs::directory_iterator(own.has_parent_path() ? own.parent_path() : ".", error)) {
        const std::string name = entry.path().filename().string(), prefix = own.stem().string() + ".";
        if (name == own.filename()) ranks.insert(0);
        int rank = 0;
        const auto number = name.starts_with(prefix)
                                ? std::from_chars(name.data() + prefix.size(), name.data() + name.size(), rank)
                                : std::from_chars_result{nullptr, std::errc::invalid_argument};
        if (number.ec == std::errc() && rank > 0 && fs::path(file(exr, rank)).filename() == name) ranks.insert(rank);
    }
    std::vector<std::string> files;
    for (const int rank : ranks) files.push_back(file(exr, rank));
    return files;
}

void Checkpoints::keep_others(const std::string& exr) const {
    if (!checkpoint || resume) return;
    const std::vector<std::string> files = found(exr);
    if (files.empty()) return;
    throw InputError(fmt::format("{}: found a checkpoint, which --checkpoint would replace; expected --resume to go on "
                                 "from it, or another --output, or that it is removed",
                                 files.front()));
}

/// Several processes leave a file each. They become one, whatever the number of processes now.
void Checkpoints::read(const std::string& exr, const NamedPicture& render) {
    const std::string own = file(exr); // of the first process, which the others go on from, too
    const std::vector<std::string> files = found(exr);
    if (files.empty()) return;
    for (const std::string& path : files) {
        NamedPicture next{path, read_exr(path)};
        if (!next.picture.metadata.contains("units"))
            throw InputError(path +
                             ": found no checkpoint, expected a picture with the sums that a render goes on from");
        check_same_render(render, next, SameRender::seed);
        if (next.picture.metadata["units"].empty()) continue; // written before the first unit was whole
        if (done_.name.empty()) {
            done_ = std::move(next);
        } else if (!units_of(done_).contains(units_of(next))) {
            Picture joined = join_shares(std::array{std::move(done_), std::move(next)});
            done_ = {own, std::move(joined)};
        }
    }
    if (done_.name.empty() || (files.size() == 1 && files.front() == own)) return;
    // Once it is written what is in the others is in it, so that a death at any point here loses nothing.
    write_exr(own, done_.picture);
    for (const std::string& path : files)
        if (path != own) fs::remove(path);
}

WorkPartition Checkpoints::share(const std::string& exr, const Picture& render, const Settings& settings,
                                 ProcessGroup* group) {
    WorkPartition share;
    if (!pass_range.empty()) {
        const auto [begin, end] = parse_range(pass_range);
        share.first_pass = begin;
        share.end_pass = end;
    }
    share.keep_sums = !pass_range.empty() || group != nullptr;
    if (share.keep_sums && (settings.passes < share.end_pass.value_or(1) || settings.target_error > 0))
        throw InputError(
            fmt::format("found passes={} and target_error={}, expected {} passes or more, a number that is "
                        "known beforehand, for what is to be shared out",
                        settings.passes, settings.target_error, share.end_pass.value_or(1)));
    if (settings.adaptive && (asked() || group != nullptr))
        throw InputError("found adaptive=true, expected false of a render that is made in parts, or may be: none of "
                         "them knows how noisy the others' samples are");
    if (group != nullptr) {
        share.take_number = [group] { return group->take_number(); };
        share.processes = group->size();
        share.communicator = group;
    }
    if (checkpoint && std::isnan(*checkpoint)) throw InputError("--checkpoint: found nan, expected seconds");
    if (file(exr).empty()) return share;
    const int rank = group != nullptr ? group->rank() : 0;
    if (resume) {
        if (rank == 0) read(exr, {"the render", render});
        if (group != nullptr) group->wait_for_all(); // until the first has made one file of all
        if (rank > 0 && fs::exists(file(exr))) {
            done_ = {file(exr), read_exr(file(exr))};
            done_.picture.sums.clear(); // the first process has them
        }
        // Whoever goes on before all have read would write over it, and its new units would be done twice.
        if (group != nullptr) group->wait_for_all();
        if (!done_.name.empty()) share.done = &done_.picture;
    }
    share.save_every = checkpoint.value_or(kSeconds);
    share.save = [path = file(exr, rank), identity = render.metadata](Picture picture) {
        picture.metadata.insert(identity.begin(), identity.end());
        try {
            write_exr(path, picture);
        } catch (const InputError& e) {
            // A full disk is no reason to lose the render as well: there may be room again.
            tell("keyhole: warning: no checkpoint: {}\n", e.what());
        }
    };
    return share;
}

} // namespace keyhole
