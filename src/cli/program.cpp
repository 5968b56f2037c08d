#include "cli/program.h"

#include "cli/process_group.h"
#include "cli/words/tell.h"
#include "core/error.h"
#include "scene/load/input.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <exception>
#include <fcntl.h>
#include <new>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace keyhole {
namespace {

/// An argument as a shell would want it.
std::string quoted(std::string_view argument) {
    constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string_view::npos) return std::string(argument);
    std::string s = "'";
    for (const char c : argument) s += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return s + "'";
}

std::string joined(int argc, char** argv) {
    std::string line = "keyhole";
    for (int i = 1; i < argc; ++i) line += " " + quoted(argv[i]);
    return line;
}

/// One line on stderr.
int fail(int code, std::string message) {
    std::ranges::replace(message, '\n', ' ');
    tell("keyhole: {}\n", message);
    return code;
}

/// @throws InputError where a word stands for a command that is none.
void check_command(const CLI::App& app, std::string_view word) {
    std::set<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.insert(command->get_name());
    if (word.starts_with('-') || names.contains(std::string(word))) return;
    throw InputError(fmt::format("found the command '{}', {} (see --help)", word,
                                 expected_one_of(word, {names.begin(), names.end()})));
}

/// What is wrong with arguments that nothing takes.
std::string unexpected(const CLI::App& app) {
    const CLI::App* command = &app;
    while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
    const std::vector<std::string> rest = app.remaining(true);
    std::vector<std::string> names;
    for (const CLI::Option* option : command->get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const auto word = std::ranges::find_if(rest, [](const std::string& r) { return r.starts_with("--"); });
    const bool has_settings = command->get_option_no_throw("-D") != nullptr;
    return fmt::format("found {}, which {} doesn't take{}{} (see --help)", fmt::join(rest, " "), command->get_name(),
                       word != rest.end() ? did_you_mean(*word, {names.begin(), names.end()}) : "",
                       has_settings ? "; settings are given as -D KEY=VALUE" : "");
}

/// Makes the standard streams safe to write to: those that are closed become empty ones, for else a picture could get
/// their number and messages would go into it. And where nobody reads a stream any more, or a file may not grow,
/// writing is to fail, and not to end the program.
void secure_standard_streams() {
    // The lowest number that is free is taken: all up to that of stderr, once they are open.
    int opened = 0;
    do opened = open("/dev/null", O_RDWR);
    while (opened >= 0 && opened <= STDERR_FILENO);
    if (opened > STDERR_FILENO) close(opened);
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

int run(int argc, char** argv, ProcessGroup* group) {
    CLI::App app("Metropolis photon sampling: a physically based renderer.", "keyhole");
    app.set_version_flag("--version", "keyhole " KEYHOLE_VERSION "\n" KEYHOLE_BUILD);
    app.require_subcommand(1);
    Action action;
    add_render_command(app, action, joined(argc, argv), group);
    add_merge_command(app, action, joined(argc, argv));
    add_diff_command(app, action);
    add_paths_command(app, action);
    add_experiment_command(app, action);
    add_info_command(app, action);
    add_chart_command(app, action);
    add_inspect_command(app, action);
    add_plan_command(app, action);
    if (argc > 1) check_command(app, argv[1]);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ExtrasError&) {
        return fail(kBadInput, unexpected(app));
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) return app.exit(e); // help and version
        return fail(kBadInput, std::string(e.what()) + " (see --help)");
    }
    if (group != nullptr && group->rank() > 0 && !app.got_subcommand("render")) return kSuccess;
    const int code = action();
    if (std::fflush(stdout) == 0) return code;
    if (errno == EPIPE) throw std::system_error(EPIPE, std::generic_category());
    return fail(kInternalError, "cannot write to the standard output");
}

} // namespace

int run_program(int argc, char** argv, ProcessGroup* group) {
    secure_standard_streams();
    try {
        return run(argc, argv, group);
    } catch (const InputErrors& e) {
        for (const std::string& line : e.lines()) fail(kBadInput, line);
        return kBadInput;
    } catch (const InputError& e) {
        return fail(kBadInput, e.what());
    } catch (const ProcessLost& e) {
        return fail(kInternalError, e.what());
    } catch (const std::system_error& e) {
        // A reader that has seen enough knows.
        if (e.code().value() == EPIPE) return kInternalError;
        return fail(kInternalError, fmt::format("internal error: {}", e.what()));
    } catch (const std::bad_alloc&) {
        return fail(kBadInput, "not enough memory for what is asked: try fewer pixels, samples or threads, or "
                               "less photon_memory");
    } catch (const std::exception& e) {
        return fail(kInternalError, fmt::format("internal error: {}", e.what()));
    }
}

void set_resolution(ImageWindow& window, const std::string& text) {
    constexpr int kMostSide = 65536, kMostPixels = 1 << 28; // as in scene files
    int width = 0, height = 0;
    const char* const last = text.data() + text.size();
    const auto x = std::from_chars(text.data(), last, width);
    const bool cross = x.ec == std::errc{} && x.ptr != last && *x.ptr == 'x';
    const auto y = cross ? std::from_chars(x.ptr + 1, last, height) : x;
    const auto in_range = [](int side) { return side >= 1 && side <= kMostSide; };
    if (!cross || y.ec != std::errc{} || y.ptr != last || !in_range(width) || !in_range(height) ||
        width > kMostPixels / height)
        throw InputError(
            fmt::format("found --resolution '{}', expected WIDTHxHEIGHT, 1 to 65536 each, at most 2^28 pixels",
                        text.substr(0, 40)));
    window.width = width;
    window.height = height;
}

} // namespace keyhole
