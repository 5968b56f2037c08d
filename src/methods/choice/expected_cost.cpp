#include "methods/choice/expected_cost.h"

#include "methods/choice/method_trials.h"
#include "methods/method.h"

#include <algorithm>

namespace keyhole {
namespace {

/// What a trial of one method should take, and may take; what those of all methods may [s].
constexpr double kTrialOfCost = 0.1, kLongest = 0.6, kAll = 0.6;
/// More time than any trial waits for: only the caps on trials count.
constexpr double kEver = 1e6;

/// Trials with so much time left.
template <class Body> auto with_time(const TrialContext& c, double seconds, const Body& body) {
    StopToken stop;
    stop.set_cpu_limit(cpu_seconds() + seconds);
    RunContext context;
    context.stop = &stop;
    return body(TrialContext{c.scene, c.settings, c.given, context, c.user_paths, c.findings});
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
    return with_time(c, kEver, [&](const TrialContext& t) { return try_cost(t, method, kTrialOfCost, kLongest); });
}

} // namespace

double ExpectedCost::cpu_seconds() const {
    double sum = 0;
    for (const auto& stage : stages) sum += stage.second;
    return sum;
}

ExpectedCost expect_cost(Scene& scene, const Settings& settings, const UserPathFile& user_paths, Findings& findings,
                         std::optional<double> time, const std::set<std::string>& given) {
    const double start = cpu_seconds();
    double trials = 0; // CPU seconds of those that a render makes as well
    const UserPaths paths = bind_user_paths(scene, user_paths);
    const RunContext none;
    Settings s = settings;
    const TrialContext c{scene, s, given, none, paths, findings};
    const double pixels = scene.camera().window().size();
    ExpectedCost expected;
    if (settings.method == &methods::automatic) {
        double seconds = time.value_or(kEver);
        if (!time) {
            s.method = &methods::ipm;
            const auto ipm = can_show(scene, *s.method) ? cost_of(c, *s.method) : std::nullopt;
            if (ipm) seconds = ipm->cost.predict(s, pixels);
        }
        const auto tried = with_time(c, seconds, [](const TrialContext& t) { return try_methods(t, kAll); });
        trials = cpu_seconds() - start;
        if (!tried.empty()) {
            expected.remarks.push_back(describe_choice(tried));
            if (time)
                s.method = tried.front().method;
            else
                s = settings_of_same_work(c, tried);
        }
    }
    expected.method = s.method->name;
    const auto cost = cost_of(c, *s.method);
    if (cost && time) {
        // A render has its trials within the time, and makes none where somebody named a method that samples pixels.
        if (settings.method != &methods::automatic && !s.method->samples_pixels) trials = cpu_seconds() - start;
        if (trials > 0) expected.stages.emplace_back(stages::trials.name, std::min(trials, *time));
        s = settings_in_time(*cost, s, given, pixels, *time - expected.cpu_seconds());
    }
    if (cost)
        for (const auto& [stage, taken] : cost->cost.stages)
            expected.stages.emplace_back(stage->name, cost->cost.predict(*stage, taken, s, pixels));
    if (s.method->keeps_photons && findings.plan && findings.plan->photons)
        expected.photon_bytes = static_cast<std::uint64_t>(s.photon_memory);
    return expected;
}

} // namespace keyhole
