#include "cli/chart/process.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>

namespace keyhole {
namespace {

pid_t start(const std::string& program, const std::vector<std::string>& arguments, const std::string& log) {
    std::vector<char*> argv;
    std::string name = program;
    argv.push_back(name.data());
    std::vector<std::string> words = arguments;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
    pid_t pid = 0;
    const int error = posix_spawnp(&pid, program.c_str(), &files, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) throw std::system_error(error, std::generic_category(), "cannot start " + program);
    return pid;
}

std::string last_line(const std::string& path) {
    std::ifstream file(path);
    std::string last;
    for (std::string line; std::getline(file, line);)
        if (!line.empty()) last = line;
    return last;
}

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

} // namespace

ProcessResult run_process(const std::string& program, const std::vector<std::string>& arguments, const std::string& log,
                          const StopToken& stop) {
    const auto began = std::chrono::steady_clock::now();
    const pid_t pid = start(program, arguments, log);
    int status = 0;
    rusage usage{};
    for (bool killed = false;;) {
        const pid_t ended = wait4(pid, &status, WNOHANG, &usage);
        if (ended == pid) break;
        if (ended < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "lost " + program);
        if (stop.requested() && !killed) killed = kill(pid, SIGKILL) == 0;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - began;
    return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            .cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime),
            .wall_seconds = wall.count(),
            .peak_bytes = std::int64_t{usage.ru_maxrss} * 1024,
            .message = last_line(log)};
}

} // namespace keyhole
