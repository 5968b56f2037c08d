// The memory of a render from outside: what the system says that the program held at most.
#include "support/program.h"
#include "support/sanitizers.h"

#include <sys/resource.h>

using namespace keyhole;

namespace {

struct Budget {
    const char* method;
    int mib;
};

class PeakMemory : public Program, public testing::WithParamInterface<Budget> {};

/// Beside photons there is the program with its libraries and the scene, and with mps its chains of whole paths:
/// docs/photon-maps.md. The rest is room for other systems' libraries.
double constant_mib(const std::string& method) { return method == "mps" ? 48 : 32; }

TEST_P(PeakMemory, IsTheCeilingAndAConstant) {
    if (test::kSanitized) GTEST_SKIP() << "a sanitizer's shadow is larger than what it watches";
    const auto [method, mib] = GetParam();
    // Light paths enough to fill the stores; few photons in an estimate, since what they cost is time.
    const int paths = std::min(20'000 * mib, 700'000);
    const pid_t pid =
        start("render " KEYHOLE_SOURCE_DIR "/scenes/box.yaml -q --no-png -o a.exr --resolution 16x12 -t 2 -D method=" +
              std::string(method) + " -D spp=1 -D nearest=9 -D irradiance_cache=false -D brightness_samples=20000" +
              " -D light_paths=" + std::to_string(paths) + " -D mutations=" + std::to_string(paths) +
              " -D photons=0 --photon-memory " + std::to_string(mib) + "MiB");
    int status = 0;
    rusage usage{};
    wait4(pid, &status, 0, &usage);
    ASSERT_EQ(status, 0) << read("err");
    const double peak = static_cast<double>(usage.ru_maxrss) / 1024; // of KiB
    RecordProperty("peak_mib", std::to_string(peak));
    EXPECT_LE(peak, mib + constant_mib(method));
    if (mib >= 16) {
        EXPECT_GT(peak, 0.75 * mib) << "the ceiling was not put to the test";
    }
}

INSTANTIATE_TEST_SUITE_P(Budgets, PeakMemory,
                         testing::Values(Budget{"pm", 1}, Budget{"pm", 4}, Budget{"pm", 16}, Budget{"pm", 64},
                                         Budget{"ipm", 1}, Budget{"ipm", 16}, Budget{"mps", 1}, Budget{"mps", 4}),
                         [](const auto& info) {
                             return std::string(info.param.method) + std::to_string(info.param.mib) + "MiB";
                         });

} // namespace
