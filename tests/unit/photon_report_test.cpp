// What photons and records are warned of.
#include "core/render_stats.h"
#include "methods/photons/photon_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace keyhole {
namespace {

RenderStats of_records(double noise, std::optional<PhotonQuality::Noise> seen) {
    RenderStats stats;
    stats.photons_global = 1000;
    stats.photon_quality.lookups = PhotonQuality::Lookups{60, 50, 1};
    stats.photon_quality.cache = PhotonQuality::Cache{100, noise, 0};
    stats.photon_quality.noise = seen;
    return stats;
}

bool warns(RenderStats stats, std::int64_t passes = 1) {
    warn_of_photons(stats, passes, 24);
    return !stats.warnings.empty();
}

TEST(PhotonReport, NoisyRecordsAreWarnedOfWhereTheyShow) {
    EXPECT_TRUE(warns(of_records(0.5, PhotonQuality::Noise{0.1, 0.04})));
    EXPECT_FALSE(warns(of_records(0.5, PhotonQuality::Noise{0.1, 1e-4}))); // beside direct light they are nothing
    EXPECT_FALSE(warns(of_records(0.1, PhotonQuality::Noise{0.1, 0.04}))); // as good as records are
    EXPECT_TRUE(warns(of_records(0.5, std::nullopt)));                     // nobody knows
}

TEST(PhotonReport, PassesMakeRecordsBetter) {
    EXPECT_TRUE(warns(of_records(0.5, PhotonQuality::Noise{0.1, 0.04}), 4));
    EXPECT_FALSE(warns(of_records(0.5, PhotonQuality::Noise{0.1, 0.04}), 20)); // to 4.5 % of the picture
}

TEST(PhotonReport, LostPowerIsWarnedOf) {
    RenderStats stats = of_records(0.1, PhotonQuality::Noise{0.1, 0.01});
    EXPECT_FALSE(warns(stats)); // no outliers are cut off by `pm`
    stats.photon_quality.cut_off = 0.05;
    EXPECT_FALSE(warns(stats));
    stats.photon_quality.cut_off = 0.3;
    EXPECT_TRUE(warns(stats));
}

} // namespace
} // namespace keyhole
