// What keyhole chart makes of its runs: slopes, times, and a log that survives an interruption.
#include "cli/chart/analysis.h"
#include "cli/chart/runs.h"
#include "core/error.h"
#include "support/scratch_directory.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace keyhole;

namespace {

/// Points whose error is scale * time^exponent.
std::vector<Point> power_law(double scale, double exponent, const std::vector<double>& times) {
    std::vector<Point> points;
    for (const double t : times) {
        const double error = scale * std::pow(t, exponent);
        points.push_back({.method = "m",
                          .seconds = t,
                          .memory = 0,
                          .cpu_seconds = t,
                          .chosen = {},
                          .stages = {},
                          .squared = {.error = error * error, .each = {error * error}},
                          .picture = {}});
    }
    return points;
}

std::vector<const Point*> pointers(const std::vector<Point>& points) {
    std::vector<const Point*> found;
    for (const Point& p : points) found.push_back(&p);
    return found;
}

ChartOptions options() {
    ChartOptions o;
    o.scenes = {"a.yaml", "b.yaml"};
    o.methods = {"auto", "ipm", "path"};
    o.times = {1, 4};
    o.repeats = 2;
    o.memories = {1 << 20};
    return o;
}

} // namespace

TEST(Chart, SlopeOfAPowerLawIsItsExponent) {
    const auto points = power_law(0.4, -0.37, {1, 2, 5, 16});
    EXPECT_NEAR(*slope(pointers(points)), -0.37, 1e-12);
    EXPECT_FALSE(slope(pointers(power_law(1, -1, {3}))));
    EXPECT_FALSE(slope({}));
}

TEST(Chart, TimeToAnErrorIsReadOffTheCurve) {
    const auto points = power_law(0.4, -0.5, {1, 2, 4, 8});
    EXPECT_NEAR(*time_to(pointers(points), 0.4 / std::sqrt(3.0)), 3, 1e-12);
    EXPECT_FALSE(time_to(pointers(points), 0.1));
    EXPECT_EQ(*time_to(pointers(points), 0.5), 1);
}

TEST(Chart, AnErrorThatComesBackIsReachedOnlyForGood) {
    auto points = power_law(0.4, -0.5, {1, 2, 4, 8});
    points[2].squared.error = 1; // a firefly at 4 s
    EXPECT_GT(*time_to(pointers(points), 0.3), 4);
}

TEST(Chart, RunsCoverTimesAndMemoriesShortOnesFirst) {
    const std::vector<keyhole::Run> runs = all_runs(options());
    // 2 times, 2 scenes, 3 methods, 2 repeats; then ipm alone keeps photons by a sampler of its own.
    ASSERT_EQ(runs.size(), 24u + 4u);
    for (std::size_t i = 1; i < runs.size(); ++i) EXPECT_LE(runs[i - 1].seconds, runs[i].seconds);
    for (std::size_t i = 24; i < runs.size(); ++i) {
        EXPECT_EQ(runs[i].method, "ipm");
        EXPECT_EQ(runs[i].seconds, 4);
        EXPECT_EQ(runs[i].memory, 1 << 20);
    }
}

TEST(Chart, MethodsBringTheirSettings) {
    EXPECT_EQ(method_settings("mps:power=literal:nearest=30"),
              (std::vector<std::string>{"method=mps", "power=literal", "nearest=30"}));
}

TEST(Chart, LogKeepsResultsAndForgetsALineCutShort) {
    const ScratchDirectory scratch;
    const std::string path = scratch.path("runs.jsonl");
    {
        RunLog log(path);
        log.add("a",
                {.cpu_seconds = 1.5, .peak_bytes = 77, .chosen = "ipm", .stages = {{"gather", 0.25}}, .failure = {}});
        log.add("b", {.chosen = {}, .stages = {}, .failure = "ended by a signal"});
        log.add("caf\xe9", {.chosen = "path", .stages = {}, .failure = {}}); // not UTF-8
    }
    std::ofstream(path, std::ios::app) << R"({"key":"c","cpu_sec)";
    const RunLog log(path);
    ASSERT_TRUE(log.find("a") && log.find("b"));
    EXPECT_EQ(log.find("a")->cpu_seconds, 1.5);
    EXPECT_EQ(log.find("a")->peak_bytes, 77);
    EXPECT_EQ(log.find("a")->chosen, "ipm");
    EXPECT_EQ(log.find("a")->stages, (std::vector<std::pair<std::string, double>>{{"gather", 0.25}}));
    EXPECT_EQ(log.find("b")->failure, "ended by a signal");
    EXPECT_FALSE(log.find("c"));
    ASSERT_TRUE(log.find("caf\xe9"));
    EXPECT_EQ(log.find("caf\xe9")->chosen, "path");
    scratch.write("other.txt", "no log\n");
    EXPECT_THROW(RunLog(scratch.path("other.txt")), InputError);
}
