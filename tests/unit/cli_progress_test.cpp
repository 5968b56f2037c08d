// What the command line prints: progress, numbers, statistics.
#include "cli/progress/interrupt.h"
#include "cli/progress/terminal_progress.h"
#include "cli/words/report.h"
#include "cli/words/units.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>
#include <thread>
#include <vector>

using namespace keyhole;
using namespace std::chrono_literals;
using testing::HasSubstr;

namespace {

/// A file in memory and a clock that stands still until told.
struct Screen {
    TerminalProgress::Clock::time_point time;
    std::FILE* file = std::tmpfile();

    Screen() = default;
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;
    ~Screen() { std::fclose(file); }

    std::string text() const {
        std::rewind(file);
        std::string s;
        for (int c = std::getc(file); c != EOF; c = std::getc(file)) s += static_cast<char>(c);
        return s;
    }
};

std::ptrdiff_t count(const std::string& text, char c) { return std::ranges::count(text, c); }

} // namespace

TEST(TerminalProgress, PromisesNoEndWhereThereIsNone) {
    for (const bool terminal : {true, false}) {
        Screen screen;
        TerminalProgress progress(screen.file, terminal, 100, [&] { return screen.time; });
        progress.begin("path tracing", 0, "samples");
        screen.time += 2s;
        progress.advance(4000);
        EXPECT_THAT(screen.text(), HasSubstr("path tracing: 4.00 ksamples  2.00 ksamples/s"));
        EXPECT_THAT(screen.text(), testing::Not(testing::AnyOf(HasSubstr("%"), HasSubstr("left"))));
    }
}

TEST(TerminalProgress, RedrawsALineAtMostTenTimesASecond) {
    Screen screen;
    TerminalProgress progress(screen.file, true, 100, [&] { return screen.time; });
    progress.begin("gather", 1000, "samples");
    for (int i = 0; i < 1000; ++i) {
        screen.time += 1ms;
        progress.advance(1);
    }
    progress.end();
    const std::string text = screen.text();
    EXPECT_EQ(count(text, '\r'), 1 + 10 + 1);
    EXPECT_EQ(count(text, '\n'), 1);
    EXPECT_THAT(text, HasSubstr("gather [############............]  50 %  1.00 ksamples/s  0.5 s left"));
    EXPECT_THAT(text, testing::EndsWith("gather: 1.00 ksamples in 1.0 s, 1.00 ksamples/s\n"));
}

TEST(TerminalProgress, PlainLinesComeEveryTenthOrTenSeconds) {
    Screen screen;
    TerminalProgress progress(screen.file, false, 80, [&] { return screen.time; });
    progress.begin("slow", 1000, "units");
    for (int i = 0; i < 100; ++i) { // 100 s, 1 % in all: ten lines
        screen.time += 1s;
        if (i % 10 == 9) progress.advance(1);
    }
    EXPECT_EQ(count(screen.text(), '\n'), 10);
    progress.begin("steady", 100, "units");
    for (int i = 0; i < 100; ++i) { // 50 s, each tenth 5 s: ten lines
        screen.time += 500ms;
        progress.advance(1);
    }
    EXPECT_EQ(count(screen.text(), '\n'), 20);
    progress.begin("quick", 100, "units");
    for (int i = 0; i < 100; ++i) progress.advance(1);
    EXPECT_EQ(count(screen.text(), '\n'), 20);
    EXPECT_EQ(count(screen.text(), '\r'), 0);
}

TEST(TerminalProgress, AStageThatEndsByTimeIsNotJudgedByItsWork) {
    Screen screen;
    double left = 8; // of 10 s that a process with two threads computes
    TerminalProgress progress(
        screen.file, true, 100, [&] { return screen.time; }, [&] { return left; });
    progress.begin("path tracing", 1'000'000'000, "samples");
    screen.time += 1s;
    left -= 2;
    progress.advance(1000);
    EXPECT_THAT(screen.text(), HasSubstr("path tracing [######..................]  25 %  1.00 ksamples/s  3.0 s left"));
    progress.begin("gather", 1000, "samples"); // that will be done before
    screen.time += 1s;
    left -= 2;
    progress.advance(500);
    EXPECT_THAT(screen.text(), HasSubstr("gather [############............]  50 %  500 samples/s  1.0 s left"));
    progress.begin("late", 1000, "samples"); // when time is up
    left = 0;
    screen.time += 1s;
    progress.advance(100);
    EXPECT_THAT(screen.text(), testing::Not(testing::AnyOf(HasSubstr("nan"), HasSubstr("inf"), HasSubstr("-"))));
}

TEST(TerminalProgress, PlainLinesComeEveryTenthOfTheTime) {
    Screen screen;
    double left = 20;
    TerminalProgress progress(
        screen.file, false, 80, [&] { return screen.time; }, [&] { return left; });
    progress.begin("path tracing", 1'000'000'000, "samples");
    for (int i = 0; i < 80; ++i) { // 20 s: a line after one, and then one for every two
        screen.time += 250ms;
        left -= 0.25;
        progress.advance(100);
    }
    EXPECT_THAT(count(screen.text(), '\n'), testing::AllOf(testing::Ge(9), testing::Le(11)));
}

TEST(TerminalProgress, NeverWritesPastTheLastColumn) {
    Screen screen;
    TerminalProgress progress(screen.file, true, 30, [&] { return screen.time; });
    progress.begin("a stage with a long name", 10, "units");
    EXPECT_LE(screen.text().size(), 29 + std::string("\r\033[K").size());
}

TEST(TerminalProgress, CountsWhatManyThreadsReport) {
    Screen screen;
    TerminalProgress progress(screen.file, false);
    progress.begin("gather", 40'000, "samples");
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            for (int i = 0; i < 10'000; ++i) progress.advance(1);
        });
    for (std::thread& t : threads) t.join();
    progress.end();
    EXPECT_THAT(screen.text(), HasSubstr("gather: 40.0 ksamples in"));
}

TEST(TerminalProgress, UnknownTotalsDoNotDivide) {
    Screen screen;
    TerminalProgress progress(screen.file, true, 80, [&] { return screen.time; });
    progress.begin("endless", 0, "units");
    screen.time += 1s;
    progress.advance(5);
    EXPECT_THAT(screen.text(), testing::Not(testing::AnyOf(HasSubstr("nan"), HasSubstr("inf"))));
}

TEST(Units, HaveThreeDigits) {
    EXPECT_EQ(with_prefix(0), "0 ");
    EXPECT_EQ(with_prefix(7), "7 ");
    EXPECT_EQ(with_prefix(999), "999 ");
    EXPECT_EQ(with_prefix(999.7), "1.00 k");
    EXPECT_EQ(with_prefix(0.25), "0.25 ");
    EXPECT_EQ(with_prefix(0.004), "4.00 m");
    EXPECT_EQ(with_prefix(1.21e-8), "12.1 n");
    EXPECT_EQ(with_prefix(12'345), "12.3 k");
    EXPECT_EQ(with_prefix(1.5e6), "1.50 M");
    EXPECT_EQ(duration(3.21), "3.2 s");
    EXPECT_EQ(duration(59.97), "1 min 00 s");
    EXPECT_EQ(duration(125), "2 min 05 s");
    EXPECT_EQ(duration(3725), "1 h 02 min");
}

TEST(StatsJson, HoldsEveryFigure) {
    RenderStats s;
    s.stages = {{&stages::gather, 1.5, 3.0, 42}};
    s.proposals = {{"lens", 10, 1, 2, 3, 4, {{"blocked", 0}}, 0.5}};
    s.brightness = NAN;
    s.warnings = {"careful"};
    s.values["chains"] = 7;
    s.agreement = {1.25, 0.5};
    s.complete = false;
    const auto json = nlohmann::json::parse(stats_json(s).dump());
    EXPECT_EQ(json["stages"][0]["rays"], 42);
    EXPECT_EQ(json["proposals"][0]["failed"]["blocked"], 0);
    EXPECT_EQ(json["proposals"][0]["accepted"], 4);
    EXPECT_TRUE(json["brightness"].is_null());
    EXPECT_EQ(json["warnings"][0], "careful");
    EXPECT_EQ(json["values"]["chains"], 7);
    EXPECT_EQ(json["values"]["chains, agreement (split R-hat)"], 1.25);
    EXPECT_EQ(json["complete"], false);
}

TEST(InterruptHandler, LeavesSignalsAsTheyWere) {
    const auto before = std::signal(SIGINT, SIG_IGN);
    StopToken stop;
    {
        const InterruptHandler interrupts(stop);
        std::raise(SIGINT);
        EXPECT_TRUE(stop.requested());
    }
    std::raise(SIGINT); // would end the test
    EXPECT_EQ(std::signal(SIGINT, before), SIG_IGN);
}
