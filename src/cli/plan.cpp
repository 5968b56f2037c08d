// keyhole plan: what a scene holds, what its render leaves out because of that, and what it will cost.
#include "methods/photons/plan.h"

#include "cli/program.h"
#include "cli/setting_options.h"
#include "cli/words/report.h"
#include "cli/words/units.h"
#include "core/parallel.h"
#include "core/percent.h"
#include "methods/choice/expected_cost.h"
#include "methods/method.h"
#include "scene/load/load.h"
#include "scene/texture.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>
#include <set>

namespace keyhole {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::int64_t kImportons = 32'768;

struct PlanCommand {
    std::string scene, resolution, user_paths, quality;
    std::vector<std::string> settings;
    std::optional<double> timeout, cpu_time; ///< [s]
    int threads = 0;
    bool json = false;
};

/// CPU time that a render is to take [s]; none: what its settings take.
std::optional<double> time_asked_for(const PlanCommand& o) {
    return o.timeout ? cpu_time_of(*o.timeout, o.threads) : o.cpu_time;
}

/// What is on and off. A method without photons asks none of it.
Json choices_json(const RenderPlan& plan, const Method& method) {
    Json choices = Json::array();
    for (const PlanItem& item : plan.items)
        choices.push_back(
            {{"name", item.name},
             {"on", item.on && method.keeps_photons},
             {"why",
              method.keeps_photons ? item.why : fmt::format("method {} keeps no photons to ask for", method.name)}});
    return choices;
}

Json share(double part, double whole) { return whole > 0 ? Json(part / whole) : Json(); }

Json found_json(const Scene& scene, const SceneSurvey& survey) {
    Json emitters = Json::array();
    double power = 0;
    for (const auto& emitter : scene.emitters()) power += emitter->power();
    for (std::size_t i = 0; i < scene.emitters().size(); ++i)
        emitters.push_back({{"kind", scene.emitters()[i]->kind()},
                            {"power", share(scene.emitters()[i]->power(), power)},
                            {"seen", share(survey.by_emitter[i], survey.total())}});
    const auto light = [&](LightClass c) { return share(survey.of(c).mean(), survey.total()); };
    return {{"surfaces",
             {{"specular", survey.specular},
              {"glossy", survey.glossy},
              {"diffuse", survey.diffuse},
              {"none", survey.nothing}}},
            {"light",
             {{"emission", light(LightClass::emission)},
              {"direct", light(LightClass::direct)},
              {"second", light(LightClass::second)},
              {"indirect", light(LightClass::indirect)},
              {"caustic", light(LightClass::caustic)}}},
            {"emitters", emitters},
            {"textures", loaded_images().size()},
            {"caustics_possible", scene.traits().delta},
            {"paths", survey.samples}};
}

Json plan_json(const PlanCommand& o) {
    LoadedScene loaded = load(o.scene, o.settings);
    const std::set<std::string> named = named_settings(o.settings);
    loaded.settings = with_quality_of(loaded.settings, o.quality, named);
    if (!o.user_paths.empty()) loaded.user_paths = load_user_paths(o.user_paths);
    if (!o.resolution.empty()) set_resolution(loaded.description.window, o.resolution);
    Scene scene(std::move(loaded.description));
    set_window_margin(scene, loaded.settings);
    const UserPaths paths = bind_user_paths(scene, loaded.user_paths);
    // Fewer eye paths than a render would find out by: nobody wants to wait for a plan.
    Settings quick = loaded.settings;
    quick.importons = std::min(quick.importons, kImportons);
    Findings findings;
    plan_photons(scene, quick, paths, {}, findings);
    const RenderPlan& plan = *findings.plan;
    const ExpectedCost cost =
        expect_cost(scene, loaded.settings, loaded.user_paths, findings, time_asked_for(o), named);
    Json stages = Json::object();
    for (const auto& [name, seconds] : cost.stages) stages[name] = seconds;
    return {{"scene", o.scene},
            {"found", found_json(scene, plan.survey)},
            {"choices", choices_json(plan, method_named(cost.method))},
            {"method", cost.method},
            {"remarks", cost.remarks},
            {"photon_bytes", cost.photon_bytes},
            {"photon_memory", loaded.settings.photon_memory},
            {"cpu_seconds", cost.cpu_seconds()},
            {"stages", stages}};
}

std::string share_text(const Json& share) { return share.is_null() ? "-" : percent(share.get<double>()); }

void print_shares(const char* name, const Json& shares) {
    std::string text;
    for (const auto& [key, value] : shares.items())
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", key, share_text(value));
    fmt::print("{:<12}{}\n", name, text);
}

/// Shares that add up to more than this count something twice, whatever the rounding.
constexpr double kMoreThanAll = 1.005;

/// Lists longer than this end in a summary; --json has all of it.
constexpr std::size_t kMostEmitters = 8;

void print_plan(const Json& plan) {
    const Json& found = plan["found"];
    print_shares("surfaces", found["surfaces"]);
    double surfaces = 0;
    for (const auto& [kind, share] : found["surfaces"].items()) surfaces += share.get<double>();
    if (surfaces > kMoreThanAll) fmt::print("{:<12}some are of several kinds, and count for each\n", "");
    print_shares("light", found["light"]);
    if (found["caustics_possible"].get<bool>())
        fmt::print("{:<12}as {} paths from the eye find it: caustics of lamps that these hardly ever meet may be far "
                   "more\n",
                   "", found["paths"].get<std::int64_t>());
    std::vector<Json> emitters(found["emitters"].begin(), found["emitters"].end());
    const auto seen = [](const Json& e) { return e["seen"].is_null() ? 0.0 : e["seen"].get<double>(); };
    std::ranges::stable_sort(emitters, [&](const Json& a, const Json& b) { return seen(a) > seen(b); });
    for (std::size_t i = 0; i < std::min(emitters.size(), kMostEmitters); ++i)
        fmt::print("{:<12}{}: {} of the power, {} of the light that is seen\n", i == 0 ? "emitters" : "",
                   emitters[i]["kind"].get<std::string>(), share_text(emitters[i]["power"]),
                   share_text(emitters[i]["seen"]));
    if (emitters.size() > kMostEmitters) fmt::print("{:<12}and {} more\n", "", emitters.size() - kMostEmitters);
    fmt::print("{:<12}{}\n", "textures", found["textures"].get<int>());
    for (const Json& item : plan["choices"])
        fmt::print("{:<12}{}: {}\n", item["on"].get<bool>() ? "on" : "off", item["name"].get<std::string>(),
                   item["why"].get<std::string>());
    fmt::print("{:<12}{}\n", "method", plan["method"].get<std::string>());
    for (const Json& remark : plan["remarks"]) fmt::print("{:<12}{}\n", "", remark.get<std::string>());
    fmt::print("{:<12}at most {}B for photons and what serves them, of photon_memory={}B\n", "memory",
               with_prefix(plan["photon_bytes"].get<double>()), with_prefix(plan["photon_memory"].get<double>()));
    std::string stages;
    for (const auto& [name, seconds] : plan["stages"].items())
        stages += fmt::format("{}{} {}", stages.empty() ? "" : ", ", name, duration(seconds.get<double>()));
    fmt::print("{:<12}about {} of CPU time{}: {}\n", "time", duration(plan["cpu_seconds"].get<double>()),
               plan["stages"].contains("trials") ? "" : ", besides trials", stages);
}

} // namespace

void add_plan_command(CLI::App& app, Action& action) {
    CLI::App* command = app.add_subcommand("plan", "Print what a render of a scene would do, and what it would cost");
    auto o = std::make_shared<PlanCommand>();
    command->add_option("SCENE", o->scene, "scene file (YAML, .pbrt, .gltf or .glb)")->required();
    command->add_option("--resolution", o->resolution, "WIDTHxHEIGHT in pixels");
    command->add_option("--user-paths", o->user_paths, "user paths, instead of the scene's");
    add_setting_options(*command, o->settings);
    auto* timeout =
        command->add_option("--timeout", o->timeout, "of a render in SECONDS")->check(real_range(1e-3, 1e9));
    auto* cpu_time = command->add_option("--cpu-time", o->cpu_time, "of one in SECONDS of CPU time")
                         ->check(real_range(1e-3, 1e9))
                         ->excludes(timeout);
    add_quality_option(*command, o->quality)->excludes(timeout)->excludes(cpu_time);
    command->add_option("-t,--threads", o->threads, "threads; 0: one for each core")->check(CLI::Range(0, 4096));
    command->add_flag("--json", o->json, "print one JSON object");
    command->callback([&action, o] {
        action = [o] {
            Json plan;
            with_threads(o->threads, [&] { plan = plan_json(*o); });
            if (o->json)
                fmt::print("{}\n", json_text(plan));
            else
                print_plan(plan);
            return kSuccess;
        };
    });
}

} // namespace keyhole
