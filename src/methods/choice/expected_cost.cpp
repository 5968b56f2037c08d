#include "methods/choice/expected_cost.h"

#include "core/shared_work.h"
#include "methods/choice/choose_by_work.h"
#include "methods/photons/memory_plan.h"
#include "methods/preparation.h"

#include <algorithm>

namespace keyhole {
namespace {

/// What a trial of one method should take, and may take; what those of all methods may [s].
constexpr double kTrialOfCost = 0.1, kLongest = 0.6, kAll = 3;
/// More time than any trial waits for: only the caps on trials count.
constexpr double kEver = 1e6;
/// A plan prepares for no more than so many seconds: of what a longer render finds out, this is told by as much.
constexpr double kPrepared = 60;

/// So much CPU time from now on.
class TimeLeft {
  public:
    explicit TimeLeft(double seconds) {
        stop_.set_cpu_limit(cpu_seconds() + seconds);
        context.stop = &stop_;
    }
    TimeLeft(const TimeLeft&) = delete;
    TimeLeft& operator=(const TimeLeft&) = delete;

    RunContext context;

  private:
    StopToken stop_;
};

void add_preparation(ExpectedCost& expected, const Preparation& before) {
    RenderStats stats;
    before.report(stats);
    for (const StageStats& stage : stats.stages) expected.stages.emplace_back(stage.stage->name, stage.cpu_seconds);
    expected.remarks.insert(expected.remarks.end(), stats.remarks.begin(), stats.remarks.end());
}

Settings settings_in_time(const TrialCost& cost, Settings s, const std::set<std::string>& given, double pixels,
                          double seconds) {
    double effort = 0;
    if (!s.method->samples_pixels) return cost.settings_for(s, given, pixels, seconds, effort);
    if (!given.contains("spp"))
        s.spp = std::max<std::int64_t>(1, static_cast<std::int64_t>(seconds / cost.per_sample(pixels)));
    return s;
}

std::optional<TrialCost> cost_of(const TrialContext& c, const Method& method) {
    const TimeLeft ever(kEver);
    return try_cost({c.scene, c.settings, c.given, ever.context, c.user_paths, c.findings}, method, kTrialOfCost,
                    kLongest);
}

/// The method of `s` for a render of so many seconds becomes the one that `auto` takes. @returns its cost
std::optional<TrialCost> choose_in_time(const TrialContext& c, Settings& s, ExpectedCost& expected) {
    std::vector<TriedMethod> tried = try_methods(c, kAll);
    if (tried.empty()) {
        s.method = &methods::path;
        return std::nullopt;
    }
    expected.remarks.push_back(describe_choice(c, tried));
    s.method = tried.front().method;
    return std::move(tried.front().of);
}

void add_stages(ExpectedCost& expected, const Experience& cost, const Settings& s, double pixels) {
    for (const auto& [stage, taken] : cost.stages)
        expected.stages.emplace_back(stage->name, cost.predict(*stage, taken, s, pixels));
}

/// Of a render that the settings say the length of.
void expect_by_work(ExpectedCost& expected, Scene& scene, Settings& s, const UserPathFile& user_paths) {
    const RunContext none;
    const std::set<std::string> given;
    Preparation before(scene, s, user_paths, none);
    const TrialContext c{scene, s, given, none, before.paths(), before.findings()};
    if (s.method == &methods::automatic) {
        ChosenByWork chosen = choose_by_work(c);
        if (!chosen.why.empty()) expected.remarks.push_back(std::move(chosen.why));
        s = std::move(chosen.settings);
    }
    add_preparation(expected, before);
    if (const auto cost = cost_of(c, *s.method)) add_stages(expected, cost->cost, s, scene.camera().window().size());
}

/// Of one that fills a time. It has its trials within that, and makes none where somebody named a method that samples
/// pixels.
void expect_in_time(ExpectedCost& expected, Scene& scene, Settings& s, const UserPathFile& user_paths, double time,
                    const std::set<std::string>& given) {
    if (!given.contains("brightness_error")) s.brightness_error = 0; // stage one gets its part, no more
    const TimeLeft all(time), prepared(std::min(time, kPrepared));
    Preparation before(scene, s, user_paths, prepared.context);
    const TrialContext c{scene, s, given, all.context, before.paths(), before.findings()};
    const double start = cpu_seconds(), pixels = scene.camera().window().size();
    const bool chooses = s.method == &methods::automatic, tries = chooses || !s.method->samples_pixels;
    Settings chosen = s;
    std::optional<TrialCost> cost;
    if (chooses) cost = choose_in_time(c, chosen, expected);
    if (!cost) cost = cost_of(c, *chosen.method);
    s = std::move(chosen);
    add_preparation(expected, before);
    if (!cost) return;
    if (tries) expected.stages.emplace_back(stages::trials.name, std::min(cpu_seconds() - start, time));
    s = settings_in_time(*cost, s, given, pixels, std::max(0.0, time - expected.cpu_seconds()));
    add_stages(expected, cost->cost, s, pixels);
}

} // namespace

double ExpectedCost::cpu_seconds() const {
    double sum = 0;
    for (const auto& stage : stages) sum += stage.second;
    return sum;
}

ExpectedCost expect_cost(Scene& scene, const Settings& settings, const UserPathFile& user_paths,
                         const Findings& findings, std::optional<double> time, const std::set<std::string>& given) {
    ExpectedCost expected;
    Settings s = settings;
    try {
        if (time)
            expect_in_time(expected, scene, s, user_paths, *time, given);
        else
            expect_by_work(expected, scene, s, user_paths);
    } catch (const Interrupted&) { // too slow to tell
        if (s.method == &methods::automatic) s.method = &methods::path;
    }
    expected.method = s.method->name;
    if (s.method->keeps_photons && findings.plan && findings.plan->photons)
        expected.photon_bytes =
            most_photon_bytes(s, s.method->importance, findings.plan->caustics || findings.plan->coverage ? 2 : 1);
    return expected;
}

} // namespace keyhole
