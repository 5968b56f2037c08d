// keyhole experiment: studies that show what a method does.
#include "cli/program.h"
#include "sampling/primary/failure_study.h"

#include <fmt/format.h>

namespace keyhole {
namespace {

constexpr std::pair<const char*, Failures> kFailureModes[] = {{"reject", Failures::reject},
                                                              {"exclude", Failures::exclude},
                                                              {"exclude_large", Failures::exclude_large},
                                                              {"delay", Failures::delay}};

void print_study(const FailureStudy& study, const char* mode) {
    const FailureStudyResult r = run_failure_study(study);
    fmt::print("  {:<14}{:>10.5f}{:>10.5f}{:>11.5f}{:>9.3f}{:>12.3f}{:>10.3f}\n", mode, r.rmse, r.bias, r.deviation,
               r.failure_rate, r.acceptance_rate, r.remedied);
}

void print_header(const std::string& title) {
    fmt::print("{}\n  {:<14}{:>10}{:>10}{:>11}{:>9}{:>12}{:>10}\n", title, "failures", "rmse", "bias", "deviation",
               "failed", "acceptance", "remedied");
}

/// Zeng and Wei's study, and one where failure depends on the state, both with short and long chains.
int pfmcmc(FailureStudy study) {
    for (const double failure : {0.4, 0.6}) {
        print_header(fmt::format("normal target, failure probability {}, {} proposals", failure, study.proposals));
        study.failure = failure;
        for (const auto& [mode, failures] : kFailureModes) {
            if (failures == Failures::exclude_large) continue; // there are no large steps
            study.failures = failures;
            print_study(study, mode);
        }
    }
    study.target = FailureStudy::Target::half_normal;
    study.p_large = 0.25;
    for (const int longer : {1, 16}) {
        FailureStudy s = study;
        s.proposals *= longer;
        print_header(fmt::format("half-normal target, proposals below it fail, {} proposals", s.proposals));
        for (const auto& [mode, failures] : kFailureModes) {
            s.failures = failures;
            print_study(s, mode);
        }
    }
    return kSuccess;
}

} // namespace

void add_experiment_command(CLI::App& app, Action& action) {
    CLI::App* command = app.add_subcommand("experiment", "Run a study and print its numbers");
    command->require_subcommand(1);
    auto study = std::make_shared<FailureStudy>();
    CLI::App* failures = command->add_subcommand("pfmcmc", "Failed proposals left out of a chain, on the real line");
    failures->add_option("--proposals", study->proposals, "of each chain")->check(CLI::Range(1, 100'000'000));
    failures->add_option("--repeats", study->repeats, "independent chains")->check(CLI::Range(2, 1'000'000));
    failures->add_option("--seed", study->seed, "seed of all random streams");
    failures->callback([&action, study] { action = [study] { return pfmcmc(*study); }; });
}

} // namespace keyhole
