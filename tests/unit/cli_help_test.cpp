// What else says which commands and options there are: the manual page, and completion in a shell.
#include "support/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>

using namespace keyhole;
using testing::HasSubstr;

namespace {

/// All that a pattern's first group finds.
std::set<std::string> found(const std::string& text, const char* pattern) {
    std::set<std::string> all;
    const std::regex regex(pattern);
    for (std::sregex_iterator i(text.begin(), text.end(), regex), end; i != end; ++i) all.insert((*i)[1]);
    return all;
}

} // namespace

TEST_F(Program, TheManualPageHasAllCommandsAndOptionsOfRender) {
    std::ostringstream page;
    page << std::ifstream(KEYHOLE_SOURCE_DIR "/cmake/package/keyhole.1").rdbuf();
    const std::string text = std::regex_replace(page.str(), std::regex("\\\\-"), "-");
    ASSERT_EQ(run("--help"), 0);
    const auto commands = found(read("out"), "\n  ([a-z]+)  ");
    EXPECT_GE(commands.size(), 9u);
    for (const std::string& command : commands) EXPECT_THAT(text, HasSubstr("\n.B " + command + "\n"));
    ASSERT_EQ(run("render --help"), 0);
    const auto options = found(read("out"), "(--[a-z][a-z-]+)");
    EXPECT_GE(options.size(), 25u);
    for (const std::string& option : options) EXPECT_THAT(text, HasSubstr(option));
}

TEST_F(Program, AShellCompletesWhatHelpLists) {
    const auto completed = [&](const std::string& line) {
        scratch.write("complete.sh", "source " KEYHOLE_SOURCE_DIR "/cmake/package/keyhole.bash\n"
                                     "COMP_WORDS=(" KEYHOLE_EXECUTABLE " " +
                                         line +
                                         ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_keyhole\n"
                                         "printf '%s\\n' \"${COMPREPLY[@]}\"\n");
        EXPECT_EQ(wait(start_line("bash complete.sh")), 0);
        return read("out");
    };
    EXPECT_EQ(completed("re"), "render\n");
    EXPECT_EQ(completed("diff --he"), "--help\n");
    EXPECT_THAT(completed("render scene.yaml --t"), testing::AllOf(HasSubstr("--timeout"), HasSubstr("--threads")));
    EXPECT_EQ(completed("render scene.yaml --method mm"), "mmlt\n");
    EXPECT_EQ(completed("render scene.yaml -D photon_me"), "photon_memory=\n");
    EXPECT_EQ(completed("render scene.yaml --denoise o"), "off\n");
    EXPECT_EQ(completed("render scene.y"), "\n"); // files, by the shell
}

TEST_F(Program, HelpHasTheBoundsOfASettingThatItsErrorHas) {
    ASSERT_EQ(run("render --help"), 0);
    const std::string help = read("out");
    for (const auto& [setting, bounds] :
         {std::pair("photon_memory=1", "256KiB to 16384GiB"), {"max_depth=0", "1 to 126"}, {"p_large=2", "0 to 1"}}) {
        EXPECT_THAT(help, HasSubstr(std::string("; ") + bounds + "\n"));
        EXPECT_EQ(run(std::string("render scene.yaml -D ") + setting), 2);
        EXPECT_THAT(read("err"), HasSubstr(std::string("from ") + bounds));
    }
}
