#include "render/render_in_time.h"

#include "film/blend.h"
#include "render/effort.h"
#include "render/methods.h"
#include "render/pass_seed.h"
#include "render/stage_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace keyhole {
namespace {

constexpr double kSecondsOfEffort = 5;               // CPU time of a unit, on scenes/ at 320x240
constexpr const char* kChoice = "trial of samplers"; // the stage that chooses a method: once

/// " key=value" for each setting of `b` that `a` has otherwise.
std::string differences(const Settings& a, const Settings& b) {
    const auto list = [](const Settings& s) {
        std::vector<std::string> texts;
        visit_settings(s, [&](const char* key, const auto& value, const auto&...) {
            texts.push_back(fmt::format(" {}={}", key, printable(value)));
        });
        return texts;
    };
    const std::vector<std::string> from = list(a), to = list(b);
    std::string text;
    for (std::size_t i = 0; i < to.size(); ++i)
        if (to[i] != from[i]) text += to[i];
    return text;
}

/// What a render cost.
struct Experience {
    Settings settings; ///< with the method that was run
    double effort, pixels;
    std::vector<std::pair<std::string, double>> stages; ///< name, seconds

    /// What some stages, all if none is named, of a render with other settings would take [s].
    double foresee(const Settings& other, double its_pixels, std::initializer_list<std::string_view> names = {}) const {
        double sum = 0;
        for (const auto& [name, time] : stages)
            if (names.size() == 0 || std::ranges::find(names, name) != names.end())
                sum += time * stage_work(name, other, its_pixels) / stage_work(name, settings, pixels);
        return sum;
    }
};

/// @param seconds that the render took, of the kind that is limited: by the clock, or of CPU time.
Experience experience(const Settings& settings, double effort, double pixels, const RenderStats& stats,
                      double seconds) {
    double wall = 0, cpu = 0;
    for (const StageStats& stage : stats.stages) {
        wall += stage.wall_seconds;
        cpu += stage.cpu_seconds;
    }
    const bool by_cpu = std::abs(seconds - cpu) < std::abs(seconds - wall);
    Experience e{settings, effort, pixels, {}};
    e.stages.emplace_back("between stages", std::max(0.0, seconds - (by_cpu ? cpu : wall)));
    for (const StageStats& stage : stats.stages)
        if (stage.name != kChoice) e.stages.emplace_back(stage.name, by_cpu ? stage.cpu_seconds : stage.wall_seconds);
    return e;
}

/// Effort of the trial, as a share of what should fill the time, and at most.
constexpr double kTrial = 0.02, kTrialAtMost = 0.1;
/// What traces importance costs is told by so many walks.
constexpr std::int64_t kTrialImportons = 4000;
/// A trial's picture is smaller by so much in width and height: it is to show what effort costs, nothing else.
constexpr int kTrialScale = 4;
/// Of the time that is left, so that a render that costs a little more than was foreseen is done in time.
constexpr double kUse = 0.95;
/// The same after the trial, which shows costs less well than the render that then follows, where what each of these
/// costs at least is less than such a share of the time.
constexpr double kUseOfTrial = 0.55, kCheap = 0.15;
/// A render is worth its time if it has so much of the effort of the one before it.
constexpr double kWorthwhile = 0.25;
/// What one render shows of costs isn't stretched further than to so many times its effort.
constexpr double kMostGrowth = 200;
/// Renders with less effort than this share of a later one's tell nothing that it doesn't.
constexpr double kNegligible = 0.1;

/// The seed of the render of that number: errors have to be independent.
std::int64_t seed_of_render(const Settings& settings, std::int64_t number) {
    constexpr std::int64_t kBeyondPasses = std::int64_t{1} << 40; // no pass has such a number
    return static_cast<std::int64_t>(seed_of_pass(settings, kBeyondPasses + number));
}

/// One line of all stages of a render that a better one takes the place of.
void add_stages(StageStats& sum, const RenderStats& stats) {
    for (const StageStats& stage : stats.stages) {
        sum.wall_seconds += stage.wall_seconds;
        sum.cpu_seconds += stage.cpu_seconds;
        sum.rays += stage.rays;
    }
}

/// CPU time of some stages [s].
double seconds_of(const RenderStats& stats, std::initializer_list<std::string_view> names) {
    double seconds = 0;
    for (const StageStats& stage : stats.stages)
        if (std::find(names.begin(), names.end(), stage.name) != names.end()) seconds += stage.cpu_seconds;
    return seconds;
}

/// The split with the least error for the time of a render with `balance`: squared errors fall as the reciprocal of
/// time, so the best times are as errors times the roots of times. Nothing changes where an error isn't known.
StageBalance rebalance(const StageBalance& balance, const RenderStats& stats) {
    const auto chains = stats.values.find("chains, error of block brightness");
    const double one = seconds_of(stats, {"brightness"}), two = seconds_of(stats, {"photons", "chains"});
    if (chains == stats.values.end() || !(chains->second > 0 && stats.brightness > 0 && one > 0 && two > 0))
        return balance;
    const double to_one = stats.brightness_error / stats.brightness * std::sqrt(one);
    const double to_two = chains->second * std::sqrt(two);
    const double share = to_one / (to_one + to_two);
    // Bounds, for what short renders say of their errors is vague; and groups of chains that agree too well, as those
    // do that have not mixed, think their error smaller than it is.
    return {std::clamp(balance.brightness * share * (one + two) / one, 0.25, 1.2),
            std::clamp(balance.chains * (1 - share) * (one + two) / two, 0.9, 4.0)};
}

/// The mean of renders, weighted by their efforts: their squared errors are about as the reciprocals. What is told of
/// it is what is to be told of the one with most effort.
class MeanRender {
  public:
    bool empty() const { return !result_; }
    void add(RenderResult&& result, double effort) {
        if (!result_ || effort_ <= kNegligible * effort) {
            if (result_) add_stages(others_, result_->stats);
            result_ = std::move(result);
            effort_ = most_ = effort;
            return;
        }
        effort_ += effort;
        blend(result_->picture, result.picture, effort_ > 0 ? effort / effort_ : 0);
        result_->picture.sums.clear(); // they are of one render
        const double samples = result_->stats.samples + result.stats.samples;
        if (effort > most_) {
            most_ = effort;
            std::swap(result_->stats, result.stats);
            result_->settings = result.settings;
        }
        result_->stats.samples = samples;
        add_stages(others_, result.stats);
    }
    const Picture& picture() const { return result_->picture; }
    /// A render that gave no picture took time, too.
    void add_time_of(const RenderStats& stats) { add_stages(others_, stats); }
    RenderResult take() {
        auto& stages = result_->stats.stages;
        stages.insert(stages.begin(), others_);
        result_->stats.values["effort"] = effort_;
        return std::move(*result_);
    }

  private:
    std::optional<RenderResult> result_;
    double effort_ = 0, most_ = 0;
    StageStats others_{.name = "other renders"};
};

bool has_empty_pixels(const RenderStats& stats) {
    const auto empty = stats.values.find("empty pixels");
    return empty != stats.values.end() && empty->second > 0;
}

/// What part of what was asked for there was time for.
double share_done(const Settings& asked, const RenderStats& stats) {
    if (stats.complete && stats.proposals.empty() && !stats.values.contains("light paths")) return 1; // no light found
    const auto passes = static_cast<double>(std::max<std::int64_t>(1, asked.passes));
    double share = 1;
    if (const auto paths = stats.values.find("light paths"); paths != stats.values.end())
        share = paths->second / (passes * static_cast<double>(asked.light_paths));
    else {
        const double steps =
            std::accumulate(stats.proposals.begin(), stats.proposals.end(), 0.0,
                            [](double sum, const ProposalStats& p) { return sum + static_cast<double>(p.proposed); });
        share = steps / (passes * static_cast<double>(asked.mutations));
    }
    // Fewer samples of a pixel leave what photons and the cache know of it as it is.
    const double samples =
        keeps_photons(asked.method) && !stats.complete ? stats.samples / (passes * static_cast<double>(asked.spp)) : 1;
    return std::min(share, 1.0) * std::clamp(samples, 0.1, 1.0);
}

/// For a method that takes samples as long as there is time.
Settings with_all_samples(Settings settings, const char* method, const std::set<std::string>& given) {
    settings.method = method;
    if (!given.contains("spp")) settings.spp = 1 << 24;
    return settings;
}

/// Renders a scene as often as there is time for.
class RenderInTime {
  public:
    RenderInTime(Scene& scene, const Settings& settings, const std::set<std::string>& given, const RunContext& context,
                 const UserPathFile& user_paths, const Share& share)
        : scene_(scene), settings_(settings), given_(given), context_(context), user_paths_(user_paths), share_(share),
          window_(scene.camera().window()) {}

    RenderResult run() {
        const RenderStats trial = try_out();
        mean_.add_time_of(trial);
        if (keeps_photons(settings_.method) && foreseen(0) > left()) return trace_paths();
        for (auto effort = affordable(); effort && add_render(*effort) && !context_.stopped();) effort = affordable();
        RenderResult result = mean_.take();
        std::ranges::copy_if(trial.remarks, std::back_inserter(result.stats.remarks),
                             [](const std::string& remark) { return remark.starts_with("method "); });
        return result;
    }

  private:
    static double pixels_of(const ImageWindow& w) { return static_cast<double>(w.width) * w.height; }
    double pixels() const { return pixels_of(window_); }
    double left() const { return context_.stop->seconds_left(); }
    Settings with(double effort, double pixels) const {
        return with_effort(settings_, effort, static_cast<std::int64_t>(pixels), given_, balance_);
    }

    /// A first, small render, which chooses the method and shows what the stages cost. Its picture is of no use.
    RenderStats try_out() {
        const double start = left();
        ImageWindow small = window_;
        small.width = std::max(1, window_.width / kTrialScale);
        small.height = std::max(1, window_.height / kTrialScale);
        const double effort = std::min(kTrial * start / kSecondsOfEffort, kTrialAtMost);
        Settings chosen = with_effort(settings_, effort, static_cast<std::int64_t>(pixels_of(small)), {},
                                      balance_); // what is given may be much
        chosen.importons = std::min(chosen.importons, kTrialImportons);
        chosen.save_map.clear();
        chosen.seed = seed_of_render(settings_, renders_++);
        scene_.set_window(small);
        RenderStats stats = render(scene_, chosen, context_, user_paths_).stats;
        scene_.set_window(window_);
        learn(chosen, effort, pixels_of(small), stats, start);
        // What gather rays reach is a question of the scene, and takes time to answer.
        if (const auto stored = stats.values.find("light beyond gather rays is stored");
            stored != stats.values.end() && stored->second == 0)
            settings_.reach = "off";
        return stats;
    }

    /// Where there isn't time for the least of what photon maps take. Paths of a sample a pixel are a noisy picture,
    /// not a wrong one, and are traced even if time is up.
    RenderResult trace_paths() {
        RunContext whole = context_;
        whole.whole_round = true;
        mean_.add(render(scene_, with_all_samples(settings_, "path", given_), whole, user_paths_, share_), 0);
        RenderResult result = mean_.take();
        result.stats.warnings.push_back("too little time for " + settings_.method + " here: paths were traced instead");
        return result;
    }

    void learn(Settings settings, double effort, double pixels, const RenderStats& stats, double start) {
        settings.method = settings_.method = stats.method; // what `auto` stands for
        last_ = experience(settings, effort, pixels, stats, start - left());
        balance_ = rebalance(balance_, stats);
    }

    double foreseen(double effort) const { return last_->foresee(with(effort, pixels()), pixels()); }

    /// The most effort that the rest of the time is enough for; none where it is enough for none that is worth it.
    std::optional<double> affordable() const {
        const double worthwhile = kWorthwhile * last_->effort;
        const bool in_two = mean_.empty() && foreseen(0) < kCheap * left();
        const double seconds = (in_two ? kUseOfTrial : kUse) * left();
        double least = worthwhile, most = kMostGrowth * last_->effort;
        if (foreseen(least) > seconds) return mean_.empty() ? std::optional(least) : std::nullopt;
        if (foreseen(most) <= foreseen(least)) return last_->effort; // all that effort is was given
        while (most - least > 0.01 * least) {
            const double effort = (least + most) / 2;
            (foreseen(effort) < seconds ? least : most) = effort;
        }
        return least;
    }

    /// Returns whether it came to a picture.
    bool add_render(double effort) {
        const double start = left();
        Settings chosen = with(effort, pixels());
        RunContext limited = context_;
        if (keeps_photons(chosen.method)) {
            // Should the stages before it cost more than was foreseen, they leave stage three its time.
            limited.reserve = std::min(1.2 * last_->foresee(chosen, pixels(), {"cache", "gather"}), start / 2) /
                              static_cast<double>(std::max<std::int64_t>(1, chosen.passes));
            limited.whole_round = !mean_.empty(); // there is a picture, and photons are worth that little more time
        }
        chosen.seed = seed_of_render(settings_, renders_++);
        if (!mean_.empty()) chosen.save_map.clear();
        RenderResult result = render(scene_, chosen, limited, user_paths_, share_to_look_at());
        result.settings.seed = chosen.seed = settings_.seed;
        // Where time was up before each pixel had a sample, what was there before is the better picture.
        if (!mean_.empty() && !result.stats.complete && has_empty_pixels(result.stats)) {
            mean_.add_time_of(result.stats);
            return false;
        }
        result.stats.remarks.push_back("set by the time:" + differences(settings_, chosen));
        learn(chosen, effort, pixels(), result.stats, start);
        // One that was cut short comes to less.
        const double made = effort * share_done(chosen, result.stats);
        mean_.add(std::move(result), made);
        return true;
    }

    /// Who looks sees the mean once there is one, not the begin of what comes after.
    Share share_to_look_at() const {
        Share share = share_;
        if (share.look && !mean_.empty()) share.look = [this](const Picture&) { share_.look(mean_.picture()); };
        return share;
    }

    Scene& scene_;
    Settings settings_;
    const std::set<std::string>& given_;
    const RunContext& context_;
    const UserPathFile& user_paths_;
    const Share& share_;
    const ImageWindow window_;
    std::int64_t renders_ = 0; // begun
    StageBalance balance_;
    std::optional<Experience> last_;
    MeanRender mean_;
};

} // namespace

RenderResult render_in_time(Scene& scene, const Settings& settings, const std::set<std::string>& given,
                            const RunContext& context, const UserPathFile& user_paths, const Share& share) {
    for (const char* method : {"path", "bdpt"})
        if (settings.method == method)
            return render(scene, with_all_samples(settings, method, given), context, user_paths, share);
    Settings s = settings;
    if (!given.contains("brightness_error")) s.brightness_error = 0; // stage one gets its part of the time, no more
    return RenderInTime{scene, s, given, context, user_paths, share}.run();
}

} // namespace keyhole
